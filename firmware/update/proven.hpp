#pragma once

#include <string>
#include <string_view>

#include "update/last_update.hpp"

namespace adit::update {

/// The slot that came up healthy last and was to stay. Kept over starts of the machine; it changes by an
/// update that proves good and by the operator's word, and not by the boot loader, which goes to another slot
/// without a word. It is forgotten where that slot is to be written.
struct Proven {
  std::string slot = "";  // "": none is known yet
  std::string version = "";
  static const codec::Row kRow;
  friend bool operator==(const Proven&, const Proven&) = default;
};

/// What is proven once the slot that runs was found good: the same, another version of the same slot, or,
/// where what runs was on `trial`, that.
Proven proven_now(Proven before, const Running& running, bool trial);

/// Which other slot runs than the proven one, and why, as a sentence; "" where there is nothing to tell: it
/// is the proven one, none is known, or what runs is on `trial`.
std::string stray(const Proven& proven, const Running& running, bool trial);
/// Why none is gone back to, nor stayed in, then.
inline constexpr std::string_view kNoStray = "no unexpected slot is running";

}  // namespace adit::update
