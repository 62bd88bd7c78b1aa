#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row_file.hpp"
#include "update/bundle.hpp"
#include "update/last_update.hpp"

/// Messages, as files, between aditd, which has no privileges, and adit-update, which runs as root:
/// README.md.
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
  enum class What : std::uint8_t {
    Install,
    Stick,
    Restart,
    Back,  // into the proven slot, which is not running
    Stay,  // the running slot becomes the proven one
  };
  std::string nonce = "";  // codec::is_nonce()
  What what = What::Restart;
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
  Running running = {};
  std::string nonce = "";            // of the last request that was read
  std::string refusal = "";          // why that request failed; "": done or in progress
  std::string doing = "";            // "", "checking", "installing", "restarting"
  std::optional<int> progress = {};  // per cent of "installing"
  LastUpdate last = {};
  bool trial = false;      // on_trial()
  std::string stray = "";  // stray()
  std::optional<Offer> stick = {};
  std::string stick_trouble = "";  // why the stick's files cannot be installed, or ""
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

}  // namespace adit::update
