#pragma once

#include <string>
#include <string_view>

namespace adit::icd {

/// As HTML's text and as an attribute's value in double quotes: none of it is markup, and control characters
/// are U+FFFD.
std::string in_html(std::string_view text);

}  // namespace adit::icd
