#pragma once

#include <compare>
#include <optional>
#include <string_view>

#include "update/version.hpp"

namespace adit::update {

/// Whether a file on a stick may be a bundle: "adit-*.raucb".
bool is_bundle_name(std::string_view name);

/// Whether the name has only visible ASCII and spaces.
bool is_plain(std::string_view name);

/// The update that a file's name promises; the best compares greatest. toolchain/image names an update
/// COMPATIBLE-VERSION.raucb.
struct Promise {
  bool for_this_board = false;
  std::optional<Version> version = {};
  friend auto operator<=>(const Promise&, const Promise&) = default;
};
Promise promise_of(std::string_view name, std::string_view compatible);

}  // namespace adit::update
