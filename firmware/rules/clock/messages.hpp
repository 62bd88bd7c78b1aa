#pragma once

#include <string>
#include <string_view>

#include "clock/source.hpp"
#include "codec/row_file.hpp"

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

  /// Source to compare offers with. If the NTP server has changed, its time ranks as the operator's, so that
  /// the new server's time is accepted.
  Source trusted() const { return source == Source::Ntp && server != ntp.server ? Source::Operator : source; }
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

/// Why a request must be rejected at monotonic second `at`, or "".
std::string hindrance(const Request& request, double at, const Status& status);

}  // namespace adit::clock
