#include "clock/chrony.hpp"

#include <cmath>

#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::clock {
namespace {

constexpr std::uint8_t kVersion = 6, kRequest = 1, kReply = 2;
constexpr std::uint32_t kTracking = 33, kTrackingReply = 5, kSucceeded = 0;
constexpr std::uint32_t kIpv4 = 1, kNotSynchronised = 3;

/// Offsets in bytes.
constexpr std::size_t kCommandAt = 4, kSequenceInRequestAt = 8;
constexpr std::size_t kReplyAt = 6, kStatusAt = 8, kSequenceAt = 16, kAddressAt = 32, kFamilyAt = 48,
                      kLeapAt = 54, kTimeAt = 56, kOffsetAt = 72;

std::uint32_t number_at(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint32_t number = 0;
  for (const std::uint8_t byte : bytes.subspan(at, size)) number = number << 8 | byte;
  return number;
}

/// chrony's floating point: a signed exponent of 7 bits and a signed coefficient of 25.
double real_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  constexpr int kBits = 25, kExponents = 128;
  const std::uint32_t all = number_at(bytes, at, 4);
  int exponent = static_cast<int>(all >> kBits);
  if (exponent >= kExponents / 2) exponent -= kExponents;
  auto coefficient = static_cast<std::int64_t>(all & ((1U << kBits) - 1));
  if (coefficient >= 1 << (kBits - 1)) coefficient -= 1 << kBits;
  return std::ldexp(static_cast<double>(coefficient), exponent - kBits);
}

/// Seconds in two halves, then nanoseconds.
double time_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return number_at(bytes, at, 4) * 4294967296.0 + number_at(bytes, at + 4, 4) +
         number_at(bytes, at + 8, 4) / 1e9;
}

/// Lets aditd on this machine ask for the state of chronyd, not command it.
constexpr const char* kTells =
    "cmdport 323\nbindcmdaddress 127.0.0.1\nbindcmdaddress /\npidfile /run/adit-ntp/chronyd.pid\n";

}  // namespace

TrackingRequest tracking_request(std::uint32_t number) {
  TrackingRequest request{kVersion, kRequest};
  request[kCommandAt + 1] = kTracking;
  for (std::size_t i = 0; i < 4; ++i)
    request[kSequenceInRequestAt + i] = static_cast<std::uint8_t>(number >> (24 - 8 * i));
  return request;
}

std::optional<Tracking> read_tracking(std::span<const std::uint8_t> reply, std::uint32_t number) {
  const bool is_one =
      reply.size() == TrackingRequest{}.size() && reply[0] == kVersion && reply[1] == kReply &&
      number_at(reply, kCommandAt, 2) == kTracking && number_at(reply, kReplyAt, 2) == kTrackingReply &&
      number_at(reply, kStatusAt, 2) == kSucceeded && number_at(reply, kSequenceAt, 4) == number;
  if (!is_one) return std::nullopt;
  Tracking tracking;
  if (number_at(reply, kLeapAt, 2) == kNotSynchronised || number_at(reply, kFamilyAt, 2) != kIpv4)
    return tracking;
  tracking.server = number_at(reply, kAddressAt, 4);
  tracking.heard = time_at(reply, kTimeAt);
  tracking.behind = -real_at(reply, kOffsetAt);
  return tracking;
}

Chrony chrony_for(const Ntp& ntp, Source source, const std::string& interface) {
  icd::require(ntp.is_on());
  const bool keeps = source == Source::Ntp && !ntp.server.empty();
  const bool gives = is_set(source) && !ntp.clients.empty();
  Chrony chrony{.configuration = "# By adit-clock, of Adit's settings: chrony.conf(5)\n",
                .options = keeps ? "CHRONYD=\n" : "CHRONYD=-x\n",
                .firewall = "flush set inet adit ntp_servers\nflush set inet adit ntp_clients\n"};
  std::string& text = chrony.configuration;
  text += icd::sentence("bindacqdevice ", interface, "\nbinddevice ", interface, "\n", kTells);
  if (!ntp.server.empty()) {
    text += icd::sentence("server ", ntp.server, " iburst minpoll 3 maxpoll 5\nmakestep 0.1 -1\n");
    chrony.firewall += icd::sentence("add element inet adit ntp_servers { ", ntp.server, " }\n");
  }
  if (keeps) text += "maxchange 60 0 -1\nrtcsync\n";
  if (gives) {
    text += icd::sentence("allow ", ntp.clients, "\nlocal stratum 10\n");
    chrony.firewall += icd::sentence("add element inet adit ntp_clients { ", ntp.clients, " }\n");
  } else {
    text += "port 0\n";
  }
  return chrony;
}

}  // namespace adit::clock
