#pragma once

#include <map>
#include <string>

namespace adit::box {

/// What root's programs have to tell the box's operator, a sentence a file of this folder; by the files'
/// names. A folder that is not there, or cannot be read, has none.
std::map<std::string, std::string> read_notices(const std::string& folder);

}  // namespace adit::box
