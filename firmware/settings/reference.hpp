#pragma once

#include <string>

namespace adit::settings {

/// The table of all keys in Markdown, as README.md has it: key, meaning, default, range.
std::string reference();

}  // namespace adit::settings
