#pragma once

#include <string>
#include <string_view>

namespace adit::icd {

/// Escapes a text for HTML, also for an attribute in double quotes. A newline or tab becomes a blank, another
/// control character U+FFFD.
std::string in_html(std::string_view text);

}  // namespace adit::icd
