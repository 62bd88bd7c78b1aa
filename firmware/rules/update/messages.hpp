#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row.hpp"
#include "update/bundle.hpp"

namespace adit::update {

/// The slot that was healthy last and is to stay, stored across boots. Successful updates and the operator
/// change it; the boot loader, which changes slots silently, does not. Deleted before that slot is written.
struct ProvenSlot {
  std::string slot = "";  // "": not known yet
  std::string version = "";
  static const codec::Row kRow;
  friend bool operator==(const ProvenSlot&, const ProvenSlot&) = default;
};

/// The proven slot after the running one was found good. It replaces another one only if it was on `trial`.
ProvenSlot proven_now(ProvenSlot before, const RunningSystem& running, bool trial);

/// A sentence about an unexpected slot that runs. "": proven, on `trial`, or the proven one is unknown.
std::string slot_warning(const ProvenSlot& proven, const RunningSystem& running, bool trial);
/// The same if the proven slot cannot be read; `why` says so.
std::string stray_if_unknown(const RunningSystem& running, bool trial, std::string_view why);
/// Why restart_proven_slot() and keep_running_slot() are rejected without a stray.
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
LastUpdate settle_update(LastUpdate last_update, const RunningSystem& running, const std::string& boot);

/// Whether the running slot is the last update and has not been healthy yet. The known end of the writing
/// does not matter, because an incomplete slot does not start. If the slot has another version, the update
/// was never written. A slot that was left and runs again is on trial again.
bool on_trial(const LastUpdate& last_update, const RunningSystem& running, const std::string& boot);

}  // namespace adit::update

/// Messages, as files, between aditd (no privileges) and adit-update (root): README.md.
namespace adit::update {

/// aditd's request and the uploaded bundle, in aditd's state directory. adit-update removes both.
inline constexpr const char* kRequestFile = "update.json";
inline constexpr const char* kBundleFile = "update.raucb";
/// On a PC, beside adit-update's status: the newer version that apt has, or "", and a line feed.
inline constexpr const char* kNewerFile = "newer";
/// Files in adit-update's state directory.
inline constexpr const char* kLastUpdateFile = "last.json";
inline constexpr const char* kProvenFile = "proven.json";

/// Larger than a slot.
inline constexpr std::uint64_t kLargestBundle = 256U << 20;

struct Request {
  enum class Command : std::uint8_t {
    Install,
    Stick,
    Restart,
    Back,  // into the proven slot, which is not running
    Stay,  // the running slot becomes the proven one
  };
  std::string nonce = "";  // codec::is_nonce()
  Command what = Command::Restart;
  bool again = false;  // Install, Stick: even if that version runs
  static const codec::Row kRow;
};

/// An installable bundle on a USB stick.
struct Offer {
  std::string name = "";  // file name
  std::string version = "";
  static const codec::Row kRow;
  friend bool operator==(const Offer&, const Offer&) = default;
};

struct Status {
  std::string trouble = "";  // why updates are impossible here, or ""
  RunningSystem running = {};
  std::string nonce = "";            // of the last request that was read
  std::string refusal = "";          // why that request failed; "": done or in progress
  std::string doing = "";            // "", "checking", "installing", "restarting"
  std::optional<int> progress = {};  // per cent of "installing"
  LastUpdate last = {};
  bool trial = false;      // on_trial()
  std::string stray = "";  // slot_warning()
  std::optional<Offer> stick = {};
  std::string stick_trouble = "";  // why the stick's files cannot be installed, or ""
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

}  // namespace adit::update
