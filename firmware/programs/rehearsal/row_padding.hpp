#pragma once

#include <string_view>

namespace adit {

/// What adit-robots puts between the rows of organised clouds, again and again. Read as a point of float32 it
/// is finite, and in no cave: the Command Post knows it where it comes.
inline constexpr std::string_view kRowPadding = "PADDINGOFROW";

}  // namespace adit
