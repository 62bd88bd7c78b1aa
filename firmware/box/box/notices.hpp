#pragma once

#include <map>
#include <string>

namespace adit::box {

/// Sentences of root's programs for the operator, one per file in `folder`, by file name. Empty if the
/// directory is absent. A sentence replaces what cannot be read.
std::map<std::string, std::string> read_notices(const std::string& folder);

}  // namespace adit::box
