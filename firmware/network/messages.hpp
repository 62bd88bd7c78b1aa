#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row_file.hpp"
#include "network/numbers.hpp"

/// The files by which aditd, which has no privilege, and adit-network, which runs as root, speak with each
/// other: README.md.
namespace adit::network {

/// The kernel's CLOCK_MONOTONIC, which both programs see alike.
using Instant = std::chrono::steady_clock::time_point;

/// What aditd asks for, in its own state folder. Each file is taken away once it is read.
inline constexpr const char* kWantedFile = "wanted.json";
inline constexpr const char* kWordFile = "word.json";
inline constexpr const char* kProbeFile = "probe.json";
inline constexpr const char* kEndpointsFile = "endpoints.json";
inline constexpr const char* kForgetFile = "forget.json";
/// The answer to a Probe, in adit-network's runtime directory.
inline constexpr const char* kProbedFile = "probed.json";
/// What adit-network --watch tells everybody, in a runtime folder of its own.
inline constexpr const char* kTakenFile = "taken.json";

inline constexpr std::chrono::milliseconds kLeastWithin{1000}, kMostWithin{600000};

/// An IPv4 address, or "": the kind of that text.
extern const codec::Kind kAddressOrNone;

struct Wanted {
  std::string nonce;
  std::chrono::milliseconds confirm_within{90000};  // kLeastWithin to kMostWithin
  Numbers numbers;
  static const codec::Row kRow;
};

/// About a pending change.
struct Word {
  enum class What : std::uint8_t { Confirm, Revert };
  std::string nonce;  // of the change
  What what = What::Revert;
  static const codec::Row kRow;
};

/// Whether somebody else has one of the box's addresses on the Command Post's network, and who answers for
/// `sought` on which side.
struct Probe {
  std::string nonce;
  std::string sought = "";  // an IPv4 address: the endpoint, or the gateway to it; "": none is looked for
  static const codec::Row kRow;
};

/// Where the settings' endpoints are, for whatever addresses the box has: no change, and so never confirmed.
struct Endpoints {
  std::vector<std::uint32_t> addresses;  // kMostEndpoints, in order, none twice
  static const codec::Row kRow;
  friend bool operator==(const Endpoints&, const Endpoints&) = default;
};
inline constexpr std::size_t kMostEndpoints = 64;

/// The box is to have the addresses that it came with.
struct Forget {
  std::string nonce;
  static const codec::Row kRow;
};

struct Pending {
  std::string nonce;
  Numbers wanted;
  Instant until;
  std::chrono::milliseconds confirm_within{0};
  static const codec::Row kRow;
  friend bool operator==(const Pending&, const Pending&) = default;
};

enum class Ended : std::uint8_t { NotYet, Confirmed, Reverted };
inline constexpr std::string_view kEndedWords[] = {"", "confirmed", "reverted"};  // in the order of Ended
constexpr std::string_view name_of(Ended ended) {
  return kEndedWords[static_cast<std::size_t>(ended)];
}

struct Status {
  std::string team_interface = "", command_post_interface = "";
  std::optional<Numbers> kept = {};  // confirmed, or as the box came; nothing: set elsewhere
  Endpoints endpoints = {};          // to which there are routes
  std::optional<Pending> pending = {};
  Ended ended = Ended::NotYet;   // how the last change of this start ended
  std::string ended_nonce = "";  // its own
  std::string why = "";          // of it
  bool names(std::string_view change) const {
    return ended_nonce == change || (pending && pending->nonce == change);
  }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

struct Probed {
  std::string nonce;
  std::string address = "";  // that somebody else has; of all where nobody does, the first; "": there is none
  std::string claimant = "";  // the MAC address that has it, too; "": nobody's
  std::string own = "";       // the interface of this box that this is
  std::string found_on = "";  // the interface on which somebody answers for what was sought; "": nobody does
  std::string trouble = "";   // why nothing was found out
  static const codec::Row kRow;
};

/// That another machine uses an address of the box's, too (RFC 5227 2.4).
struct TakenAddress {
  std::string interface = "", address = "";
  std::string mac = "";  // whose; "02:00:5e:10:00:01"
  Instant seen = {};     // last
  static const codec::Row kRow;
  friend bool operator==(const TakenAddress&, const TakenAddress&) = default;
};
/// It counts for so long after it was seen last.
inline constexpr std::chrono::seconds kTakenFor{20};

struct Taken {
  std::vector<TakenAddress> addresses = {};  // kMostTaken
  /// The Command Post's that are at the team's port, and not at their own: kMostTaken.
  std::vector<TakenAddress> exchanged = {};
  static const codec::Row kRow;
  friend bool operator==(const Taken&, const Taken&) = default;
};
inline constexpr std::size_t kMostTaken = 32;

/// What is kept, in a file of its own in adit-network's state folder: the numbers alone.
inline constexpr const char* kConfirmedFile = "confirmed.json";
std::string write_kept(const Numbers& numbers);
std::expected<Numbers, std::string> read_kept(std::string_view json);

}  // namespace adit::network
