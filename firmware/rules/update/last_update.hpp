#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "update/bundle.hpp"

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

/// State of the last update. An installed update is on trial until it was healthy once.
enum class Stage : std::uint8_t {
  None,         // no update yet
  Installing,   // the other slot is being written
  Interrupted,  // the writing was interrupted; the running slot is unchanged
  Failed,       // RAUC could not write the slot in time, or at all
  Installed,    // waits for a restart; after it, on trial in that slot
  Left,         // not healthy in three starts; the boot loader returned to the other slot
  Good,         // was healthy
};
/// In the order of Stage.
inline constexpr std::string_view kStageWords[] = {"",          "installing", "interrupted", "failed",
                                                   "installed", "left",       "good"};
constexpr auto& words_of(Stage /*of*/) {
  return kStageWords;
}
constexpr std::string_view name_of(Stage stage) {
  return kStageWords[static_cast<std::size_t>(stage)];
}

/// The last update, stored across boots.
struct LastUpdate {
  Stage stage = Stage::None;
  std::string version = "";  // "": the bundle could not be read
  std::string slot = "";     // target of the installation
  std::string boot = "";     // host::boot() of the installation
  std::string why = "";      // a sentence about the stage
  static const codec::Row kRow;
  friend bool operator==(const LastUpdate&, const LastUpdate&) = default;
};

/// Updates the stage at a start of the program, in boot `boot`.
LastUpdate settled(LastUpdate last_update, const Running& running, const std::string& boot);

/// Whether the running slot is the last update and has not been healthy yet. The known end of the writing
/// does not matter, because an incomplete slot does not start. If the slot has another version, the update
/// was never written. A slot that was left and runs again is on trial again.
bool on_trial(const LastUpdate& last_update, const Running& running, const std::string& boot);

}  // namespace adit::update
