#include "clock/messages.hpp"

#include "codec/nonce.hpp"
#include "network/messages.hpp"
#include "settings/subnet.hpp"

namespace adit::clock {

std::optional<double> time_to_set(Source present, const Offer& offer, double now) {
  if (!(offer.time >= kEarliest && offer.time < kLatest)) return std::nullopt;
  const bool counts = offer.source > present || offer.source == Source::Operator;
  if (!counts) return std::nullopt;
  const bool ahead_alone = offer.source == Source::LastKnown || offer.source == Source::Robots;
  if (ahead_alone && offer.time <= now) return std::nullopt;
  if (offer.source == Source::Robots && offer.time > now + kRobotsMost) return std::nullopt;
  return offer.time;
}

namespace {

constexpr double kOldest = 60;  // seconds

constexpr codec::Member kClockRequest[] = {
    codec::member<&Request::nonce>("nonce").matching(codec::kNonce),
    codec::member<&Request::source>("source"),
    codec::member<&Request::time>("time"),
    codec::member<&Request::at>("at"),
    codec::member<&Request::boot>("boot"),
    codec::member<&Request::server>("server").matching(network::kAddressOrNone),
};
/// A subnet in the form of settings::to_text(), or "".
constexpr codec::Form kSubnetOrNone{[](std::string_view text) {
                                      const auto parsed = settings::parse_subnet(text);
                                      return text.empty() || (parsed && settings::to_text(*parsed) == text);
                                    },
                                    "a subnet, or none"};

constexpr codec::Member kNtp[] = {
    codec::member<&Ntp::server>("server").matching(network::kAddressOrNone),
    codec::member<&Ntp::clients>("clients").matching(kSubnetOrNone),
};
constexpr codec::Member kClockStatus[] = {
    codec::member<&Status::boot>("boot"),       codec::member<&Status::nonce>("nonce"),
    codec::member<&Status::refusal>("refusal"), codec::member<&Status::source>("source"),
    codec::member<&Status::server>("server"),   codec::member<&Status::ntp>("ntp"),
    codec::member<&Status::trouble>("trouble"),
};

}  // namespace

constexpr codec::Row Request::kRow = codec::complete<Request>({"", kClockRequest});
constexpr codec::Row Ntp::kRow = codec::complete<Ntp>({"", kNtp});
constexpr codec::Row Status::kRow = codec::complete<Status>({"", kClockStatus});

std::string refusal_reason(const Request& request, double at, const Status& status) {
  if (request.source == Source::None || request.source == Source::Chip)
    return "source: expected a source that can set the clock";
  if (!(request.time >= kEarliest && request.time < kLatest))
    return "time: expected seconds since 1970, from 2026 to 2099";
  if (request.boot != status.boot) return "boot: the request is of another boot";
  if (!(request.at <= at && request.at >= at - kOldest)) return "at: expected a time within the last minute";
  if (request.source == Source::Ntp && request.server != status.ntp.server)
    return "server: expected the NTP server of the settings";
  return "";
}

}  // namespace adit::clock
