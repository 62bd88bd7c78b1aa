#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "update/bundle.hpp"

namespace adit::update {

/// How far the last update has come. What is installed is on trial until it was healthy once.
enum class Stage : std::uint8_t {
  None,         // there was none
  Installing,   // the other slot is being written
  Interrupted,  // while it was: the slot that runs was not touched
  Failed,       // RAUC could not write it, or not in time
  Installed,    // waits for a restart; once the box was restarted, from that slot, on trial
  Left,         // it did not come up healthy in three starts, and the boot loader went back
  Good,         // it came up healthy
};
/// In the order of the stages.
inline constexpr std::string_view kStageWords[] = {"",          "installing", "interrupted", "failed",
                                                   "installed", "left",       "good"};
constexpr std::string_view name_of(Stage stage) {
  return kStageWords[static_cast<std::size_t>(stage)];
}

}  // namespace adit::update

namespace adit::codec {

template <>
struct KindOf<update::Stage> : KindOfWords<update::Stage, update::kStageWords> {};

}  // namespace adit::codec

namespace adit::update {

/// The last update. Kept over starts of the machine.
struct LastUpdate {
  Stage stage = Stage::None;
  std::string version = "";  // the update's; "": not known, the bundle could not be read
  std::string slot = "";     // that it was installed into
  std::string boot = "";     // the start of the machine in which it was (host::boot())
  std::string why = "";      // a sentence about the stage
  static const codec::Row kRow;
  friend bool operator==(const LastUpdate&, const LastUpdate&) = default;
};

/// What the last update has come to, as found at a start of the program, in the machine's start `boot`.
LastUpdate settled(LastUpdate last_update, const Running& running, const std::string& boot);

/// What runs is the last update, and it has not been healthy yet; whatever became known of the end of the
/// writing, for what was cut off before its end does not start. Where the slot has another version, it was
/// never written; one that was left and runs all the same is tried again.
bool on_trial(const LastUpdate& last_update, const Running& running, const std::string& boot);

}  // namespace adit::update
