#pragma once

#include <expected>
#include <string>
#include <string_view>

#include "clock/source.hpp"
#include "codec/row_file.hpp"

/// The files by which aditd, which has no privilege, and adit-clock, which runs as root, speak with each
/// other: README.md.
namespace adit::clock {

/// What aditd asks for, in its state directory.
inline constexpr const char* kRequestFile = "clock.json";
inline constexpr const char* kNtpFile = "ntp.json";

/// The words of Source, in its order.
inline constexpr std::string_view kSourceWords[] = {"none", "last_known", "robots", "command_post",
                                                    "chip", "operator",   "ntp"};

}  // namespace adit::clock

template <>
struct adit::codec::KindOf<adit::clock::Source>
    : adit::codec::KindOfWords<adit::clock::Source, adit::clock::kSourceWords> {};

namespace adit::clock {

struct Request {
  std::string nonce = "";  // codec::is_nonce()
  Source source = Source::None;
  double time = 0;          // seconds since 1970
  double at = 0;            // when that was so: seconds of the machine's monotonic clock
  std::string boot = "";    // the machine's start, as the status has it
  std::string server = "";  // that told it, where the source is ntp; else ""
  static const codec::Row kRow;
};

/// What the settings ask of NTP on the team's network: in the file of its own that lasts.
struct Ntp {
  std::string server = "";   // an IPv4 address; "": none is asked
  std::string clients = "";  // the subnet that the box is to be the server of: "10.0.0.0/24"; "": of none
  bool is_on() const { return !server.empty() || !clients.empty(); }
  static const codec::Row kRow;
  friend bool operator==(const Ntp&, const Ntp&) = default;
};

struct Status {
  std::string boot = "";         // host::boot(): requests of another start of the machine do not count
  std::string nonce = "";        // of the last request that was taken up
  std::string refusal = "";      // why it was not done; "" where it was
  Source source = Source::None;  // who set the time of day last, since the machine started
  std::string server = "";       // which NTP server's time was taken last, if any
  Ntp ntp = {};                  // what is asked of NTP
  std::string trouble = "";      // why that is not done; "" where it is

  /// As far as `source` is to be trusted still: a server that is asked no more has set it once, as the
  /// operator does, and the next one's time is to be taken.
  Source trusted() const { return source == Source::Ntp && server != ntp.server ? Source::Operator : source; }
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
  friend bool operator==(const Status&, const Status&) = default;
};

/// Why a request is not to be done at that instant of the monotonic clock (seconds), as things stand; "": it
/// is.
std::string hindrance(const Request& request, double at, const Status& status);

}  // namespace adit::clock
