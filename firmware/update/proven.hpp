#pragma once

#include <string>
#include <string_view>

#include "update/last_update.hpp"

namespace adit::update {

/// The slot that was healthy last and is to stay, stored across boots. Successful updates and the operator
/// change it; the boot loader, which changes slots silently, does not. It is deleted before that slot is
/// written.
struct Proven {
  std::string slot = "";  // "": not known yet
  std::string version = "";
  static const codec::Row kRow;
  friend bool operator==(const Proven&, const Proven&) = default;
};

/// The proven slot after the running one was found good. Another slot than the proven one replaces it only if
/// it was on `trial`.
Proven proven_now(Proven before, const Running& running, bool trial);

/// Returns a sentence with the reason if an unexpected slot runs. "": the proven slot runs or is unknown, or
/// the running slot is on `trial`.
std::string stray(const Proven& proven, const Running& running, bool trial);
/// The same if the proven slot cannot be read; `why` says so.
std::string stray_if_unknown(const Running& running, bool trial, std::string_view why);
/// Why go_back() and stay() are rejected without a stray.
inline constexpr std::string_view kNoStray = "no unexpected slot is running";

}  // namespace adit::update
