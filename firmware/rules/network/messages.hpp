#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "codec/row.hpp"
#include "network/numbers.hpp"

/// Messages, as files, between aditd, which has no privileges, and adit-network, which has: README.md.
namespace adit::network {

/// CLOCK_MONOTONIC, which both programs share.
using Instant = std::chrono::steady_clock::time_point;

/// Requests in aditd's state directory. adit-network removes each file once it has read it.
inline constexpr const char* kWantedFile = "wanted.json";
inline constexpr const char* kWordFile = "word.json";
inline constexpr const char* kProbeFile = "probe.json";
inline constexpr const char* kEndpointsFile = "endpoints.json";
inline constexpr const char* kForgetFile = "forget.json";
inline constexpr const char* kPortsFile = "ports.json";
/// The answer to a Probe, in adit-network's runtime directory.
inline constexpr const char* kProbedFile = "probed.json";
/// The address conflicts that adit-network --watch has found, in its own runtime directory.
inline constexpr const char* kTakenFile = "taken.json";

inline constexpr std::chrono::milliseconds kLeastWithin{1000}, kMostWithin{600000};

/// An IPv4 address or "".
extern const codec::Form kAddressOrNone;

struct ChangeRequest {
  std::string nonce;
  std::chrono::milliseconds confirm_within{90000};  // kLeastWithin to kMostWithin
  Numbers numbers;
  static const codec::Row kRow;
};

/// The operator's answer to a pending change.
struct Decision {
  enum class Command : std::uint8_t { Confirm, Revert };
  std::string nonce;  // of the change
  Command what = Command::Revert;
  static const codec::Row kRow;
};

/// Asks for address conflicts on the Command Post's network, and on which interface `sought` answers.
struct Probe {
  std::string nonce;
  std::string sought = "";  // the endpoint's IPv4 address, or its gateway's; "": not asked
  static const codec::Row kRow;
};

/// Addresses of the endpoints in the settings. The routes to them need no confirmation.
struct Endpoints {
  std::vector<std::uint32_t> addresses;  // at most kMostEndpoints, sorted, without duplicates
  static const codec::Row kRow;
  friend bool operator==(const Endpoints&, const Endpoints&) = default;
};
inline constexpr std::size_t kMostEndpoints = 64;

struct FactoryRequest {
  std::string nonce;
  static const codec::Row kRow;
};

/// aditd's TCP ports on the team's side, which the firewall opens.
struct TeamPorts {
  std::vector<std::uint16_t> ports;  // at most kMostTeamPorts
  static const codec::Row kRow;
  friend bool operator==(const TeamPorts&, const TeamPorts&) = default;
};
inline constexpr std::size_t kMostTeamPorts = 64;
/// The firewall's rules for the requested ports, in the runtime directory of adit-network --ports. Absent
/// before the first request of a boot: then services/adit-nftables.conf opens kFirstTeamPorts.
inline constexpr const char* kPortRulesFile = "ports.nft";
inline constexpr std::uint16_t kFirstTeamPorts[] = {80, 8000};
/// The port of stunnel, which passes its connections on to aditd (services/adit-tls.socket).
inline constexpr std::uint16_t kTlsPort = 443;
/// Commands of nft that make `ports` the only open ones, in any order and number of repetitions.
std::string rules_for(const TeamPorts& ports);

struct Pending {
  std::string nonce;
  Numbers wanted;
  Instant until;
  std::chrono::milliseconds confirm_within{0};
  static const codec::Row kRow;
  friend bool operator==(const Pending&, const Pending&) = default;
};

enum class ChangeOutcome : std::uint8_t { NotYet, Confirmed, Reverted };
inline constexpr std::string_view kOutcomeWords[] = {"", "confirmed", "reverted"};  // by ChangeOutcome
constexpr auto& words_of(ChangeOutcome /*of*/) {
  return kOutcomeWords;
}
constexpr std::string_view name_of(ChangeOutcome ended) {
  return kOutcomeWords[static_cast<std::size_t>(ended)];
}

struct Status {
  std::string team_interface = "", command_post_interface = "";
  std::optional<Numbers> kept = {};  // confirmed, or from the factory; nullopt: set elsewhere
  Endpoints endpoints = {};          // addresses that have routes
  std::optional<Pending> pending = {};
  ChangeOutcome ended = ChangeOutcome::NotYet;  // of the last change since this process started
  std::string ended_nonce = "";                 // nonce of that change
  std::string why = "";                         // reason of that end
  std::string trouble = "";                     // why adit-network cannot work, or ""
  bool names(std::string_view change) const {
    return ended_nonce == change || (pending && pending->nonce == change);
  }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

struct ProbeResult {
  std::string nonce;
  std::string address = "";     // first address with a conflict, else the box's first address; "": no address
  std::string claimant = "";    // MAC address of the other machine; "": no conflict
  std::string own = "";         // this box's interface with that MAC address, or ""
  std::string found_on = "";    // the interface on which a machine answers for `sought`; "": no answer
  std::string trouble = "";     // why the probe failed
  std::string not_sought = "";  // why the probe for `sought` failed at an interface
  static const codec::Row kRow;
};

/// An address conflict: another machine uses an address of the box (RFC 5227 2.4).
struct AddressConflict {
  std::string interface = "", address = "";
  std::string mac = "";  // of the other machine: "02:00:5e:10:00:01"
  Instant seen = {};     // last time
  static const codec::Row kRow;
  friend bool operator==(const AddressConflict&, const AddressConflict&) = default;
};
/// Time for which a conflict is reported after it was last seen.
inline constexpr std::chrono::seconds kTakenFor{20};

struct AddressConflicts {
  std::vector<AddressConflict> addresses = {};  // at most kMostTaken
  /// The Command Post's addresses that answer at the team's port instead of their own; at most kMostTaken.
  std::vector<AddressConflict> exchanged = {};
  static const codec::Row kRow;
  friend bool operator==(const AddressConflicts&, const AddressConflicts&) = default;
};
inline constexpr std::size_t kMostTaken = 32;

/// The file of the confirmed numbers, in adit-network's state directory.
inline constexpr const char* kConfirmedFile = "confirmed.json";
std::string write_kept(const Numbers& numbers);
std::expected<Numbers, std::string> read_kept(std::string_view json);

}  // namespace adit::network
