#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace adit::icd {

/// The likely intended word: at most a third of its letters, or `few`, differ, or one begins with the other.
std::optional<std::string_view> nearest(std::string_view word, std::span<const std::string_view> known,
                                        std::size_t few = 2);

/// "; did you mean status?", or "" if no word of `known` is near.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> known);

/// "; did you mean Cell Phone?" if `type` resembles one of the ICD's ten types, otherwise "". Compares
/// letters only, in any case: one text is a part of the other, or they differ by a few letters.
std::string type_hint(std::string_view type);

}  // namespace adit::icd
