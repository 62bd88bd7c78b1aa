#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace adit::spelling {

/// The one of `known` that `word` was likely meant to be: a few letters differ, or one begins with the other.
std::optional<std::string_view> nearest(std::string_view word, std::span<const std::string_view> known);

/// "; did you mean status?", or "" where none of `known` is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> known);

}  // namespace adit::spelling
