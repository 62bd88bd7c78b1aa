#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row_file.hpp"
#include "update/bundle.hpp"
#include "update/last_update.hpp"
#include "update/proven.hpp"

/// The files by which aditd, which has no privilege, and adit-update, which runs as root, speak with each
/// other: README.md.
namespace adit::update {

/// What aditd asks for and the bundle that was uploaded, in its own state folder. adit-update takes both
/// away.
inline constexpr const char* kRequestFile = "update.json";
inline constexpr const char* kBundleFile = "update.raucb";
/// What adit-update keeps, in its state directory.
inline constexpr const char* kLastUpdateFile = "last.json";
inline constexpr const char* kProvenFile = "proven.json";

/// More than both slots hold.
inline constexpr std::uint64_t kLargestBundle = 256U << 20;

struct Request {
  enum class What : std::uint8_t {
    Install,
    Stick,
    Restart,
    Back,  // into the proven slot, which does not run
    Stay,  // the slot that runs is proven from now on
  };
  std::string nonce = "";  // codec::is_nonce()
  What what = What::Restart;
  bool again = false;  // Install, Stick: though that version runs already
  static const codec::Row kRow;
};

/// A bundle on a USB stick that could be installed.
struct Offer {
  std::string name = "";  // of the file
  std::string version = "";
  static const codec::Row kRow;
  friend bool operator==(const Offer&, const Offer&) = default;
};

struct Status {
  std::string trouble = "";  // why nothing can be updated here; "" where it can
  Running running = {};
  std::string nonce = "";            // of the last request that was taken up
  std::string refusal = "";          // why it was not done; "" where it was, or is being done
  std::string doing = "";            // "", "checking", "installing", "restarting"
  std::optional<int> progress = {};  // per cent of "installing"
  LastUpdate last = {};
  bool trial = false;      // on_trial()
  std::string stray = "";  // stray()
  std::optional<Offer> stick = {};
  std::string stick_trouble = "";  // why what is on the stick cannot be installed; "" where there is none
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

}  // namespace adit::update
