#pragma once

#include <string>
#include <vector>

namespace adit::box {

/// What those who started the box have to tell its operator, a sentence a file of this folder; in the order
/// of the files' names. A folder that is not there, or cannot be read, has none.
std::vector<std::string> read_notices(const std::string& folder);

}  // namespace adit::box
