#pragma once

#include <compare>
#include <optional>
#include <string_view>

#include "update/version.hpp"

namespace adit::update {

/// Whether a file of that name on a stick is looked at: "adit-*.raucb".
bool is_bundle_name(std::string_view name);

/// Whether it can be told to everybody: of visible ASCII and spaces.
bool is_plain(std::string_view name);

/// What a file's name promises of the update in it, the greatest the most: toolchain/image calls an update
/// COMPATIBLE-VERSION.raucb.
struct Promise {
  bool for_this_board = false;
  std::optional<Version> version = {};
  friend auto operator<=>(const Promise&, const Promise&) = default;
};
Promise promise_of(std::string_view name, std::string_view compatible);

}  // namespace adit::update
