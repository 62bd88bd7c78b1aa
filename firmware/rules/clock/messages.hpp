#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "codec/row.hpp"

/// Sources of the time of day: README.md.
namespace adit::clock {

/// In the order of trust, the least trusted first.
enum class Source : std::uint8_t {
  None,         // the time at boot
  LastKnown,    // stored before the power went
  Robots,       // time stamps of robots
  CommandPost,  // the Date header of its answers
  Chip,         // a clock with its own battery
  Operator,     // the operator's browser, or `adit clock set`
  Ntp,          // a server on the team's network
};

/// Seconds since 1970: the starts of 2026, before Adit was built, and of 2100. Other times are wrong.
inline constexpr double kEarliest = 1767225600, kLatest = 4102444800;
/// Most seconds by which robots may advance the clock: a box may be stored for a season.
inline constexpr double kRobotsMost = 200.0 * 86400;

/// Whether the time is reliable.
inline bool is_set(Source source) {
  return source >= Source::CommandPost;
}

struct Offer {
  Source source = Source::None;
  double time = 0;  // seconds since 1970, now
};

/// The time to set, or std::nullopt to leave the clock. `present` set the clock last; `now` is its time. A
/// more trusted source sets it in either direction, and the operator always does. LastKnown and Robots only
/// advance it, Robots by at most kRobotsMost. The caller checks whether an NTP server keeps the clock.
std::optional<double> time_to_set(Source present, const Offer& offer, double now);

}  // namespace adit::clock

/// Messages, as files, between aditd, which has no privileges, and adit-clock, which runs as root: README.md.
namespace adit::clock {

/// Requests in aditd's state directory.
inline constexpr const char* kRequestFile = "clock.json";
inline constexpr const char* kNtpFile = "ntp.json";

/// In the order of Source.
inline constexpr std::string_view kSourceWords[] = {"none", "last_known", "robots", "command_post",
                                                    "chip", "operator",   "ntp"};
constexpr auto& words_of(Source /*of*/) {
  return kSourceWords;
}

struct Request {
  std::string nonce = "";  // codec::is_nonce()
  Source source = Source::None;
  double time = 0;          // seconds since 1970
  double at = 0;            // monotonic seconds at which `time` was right
  std::string boot = "";    // boot identifier, as in Status::boot
  std::string server = "";  // the NTP server, if the source is ntp; else ""
  static const codec::Row kRow;
};

/// NTP on the team's network, as set in the settings. Its file outlives a boot.
struct Ntp {
  std::string server = "";   // IPv4 address; "": no server
  std::string clients = "";  // subnet that the box serves: "10.0.0.0/24"; "": unset
  bool is_on() const { return !server.empty() || !clients.empty(); }
  static const codec::Row kRow;
  friend bool operator==(const Ntp&, const Ntp&) = default;
};

struct Status {
  std::string boot = "";         // host::boot(); requests of another boot are rejected
  std::string nonce = "";        // of the last request that was read
  std::string refusal = "";      // why that request failed, or ""
  Source source = Source::None;  // set the time of day last in this boot
  std::string server = "";       // NTP server whose time was set last, or ""
  Ntp ntp = {};                  // in effect
  std::string trouble = "";      // why `ntp` is not in effect, or ""

  /// To compare offers with. A former NTP server ranks as the operator, so that the new server is accepted.
  Source trusted_source() const {
    return source == Source::Ntp && server != ntp.server ? Source::Operator : source;
  }
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

/// Why a request must be rejected at monotonic second `at`, or "".
std::string refusal_reason(const Request& request, double at, const Status& status);

}  // namespace adit::clock
