#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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
/// What adit-network tells everybody, in its runtime folder.
inline constexpr const char* kStatusFile = "status.json";
inline constexpr const char* kProbedFile = "probed.json";

inline constexpr std::chrono::milliseconds kLeastWithin{1000}, kMostWithin{600000};

/// 32 hexadecimal digits that name one request.
bool is_nonce(std::string_view text);

struct Wanted {
  std::string nonce;
  std::chrono::milliseconds confirm_within{90000};  // kLeastWithin to kMostWithin
  Numbers numbers;
};

/// About a pending change.
struct Word {
  enum class What : std::uint8_t { Confirm, Back };
  std::string nonce;  // of the change
  What what = What::Back;
};

/// Whether somebody else has one of the box's addresses on the Command Post's network, and who answers for
/// `sought` on which side.
struct Probe {
  std::string nonce;
  std::string sought = "";  // an IPv4 address: the endpoint, or the gateway to it; "": none is looked for
};

/// Where the settings' endpoints are, for whatever addresses the box has: no change, and so never confirmed.
struct Endpoints {
  std::vector<std::uint32_t> addresses;  // kMostEndpoints, in order, none twice
  friend bool operator==(const Endpoints&, const Endpoints&) = default;
};
inline constexpr std::size_t kMostEndpoints = 64;

/// The box is to have the addresses that it came with.
struct Forget {
  std::string nonce;
};

struct Pending {
  std::string nonce;
  Numbers wanted;
  Instant until;
  std::chrono::milliseconds confirm_within{0};
  friend bool operator==(const Pending&, const Pending&) = default;
};

enum class Ended : std::uint8_t { NotYet, Confirmed, TakenBack };
/// "confirmed", "taken back"; "" for NotYet
std::string_view name_of(Ended ended);

struct Status {
  std::string team_interface = "", command_post_interface = "";
  std::optional<Numbers> kept = {};  // confirmed, or as the box came; nothing: set elsewhere
  Endpoints endpoints = {};          // to which there are routes
  std::optional<Pending> pending = {};
  Ended ended = Ended::NotYet;   // how the last change of this start ended
  std::string ended_nonce = "";  // its own
  std::string why = "";          // of it
  friend bool operator==(const Status&, const Status&) = default;
};

struct Probed {
  std::string nonce;
  std::string address = "";  // that somebody else has; of all where nobody does, the first; "": there is none
  std::string claimant = "";  // the MAC address that has it, too; "": nobody's
  std::string own = "";       // the interface of this box that this is
  std::string found_on = "";  // the interface on which somebody answers for what was sought; "": nobody does
  std::string trouble = "";   // why nothing was found out
};

std::string write(const Wanted& wanted);
std::string write(const Word& word);
std::string write(const Probe& probe);
std::string write(const Endpoints& endpoints);
std::string write(const Forget& forget);
std::string write(const Status& status);
std::string write(const Probed& probed);

/// Strict: an unknown or a missing member, or a value that is not what it must be, is an error that names it.
/// What these give has passed all checks.
template <class Message>
using Read = std::expected<Message, std::string>;
Read<Wanted> read_wanted(std::string_view json);
Read<Word> read_word(std::string_view json);
Read<Probe> read_probe(std::string_view json);
Read<Endpoints> read_endpoints(std::string_view json);
Read<Forget> read_forget(std::string_view json);
Read<Status> read_status(std::string_view json);
Read<Probed> read_probed(std::string_view json);

/// What is kept, in a file of its own in adit-network's state folder: the numbers alone.
inline constexpr const char* kConfirmedFile = "confirmed.json";
std::string write_kept(const Numbers& numbers);
Read<Numbers> read_kept(std::string_view json);

}  // namespace adit::network
