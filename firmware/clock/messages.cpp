#include "clock/messages.hpp"

#include "network/messages.hpp"

namespace adit::clock {
namespace {

constexpr double kOldest = 60;  // seconds

constexpr codec::Member kClockRequest[] = {
    codec::member<&Request::nonce>("nonce").as(network::kNonce),
    codec::member<&Request::source>("source"),
    codec::member<&Request::time>("time"),
    codec::member<&Request::at>("at"),
};
constexpr codec::Member kClockStatus[] = {
    codec::member<&Status::nonce>("nonce"),
    codec::member<&Status::refusal>("refusal"),
    codec::member<&Status::source>("source"),
};

}  // namespace

constexpr codec::Row Request::kRow = {"", kClockRequest};
constexpr codec::Row Status::kRow = {"", kClockStatus};

std::string hindrance(const Request& request, double at) {
  if (request.source == Source::None || request.source == Source::Chip) return "source: nobody who asks";
  if (!(request.time >= kEarliest && request.time < kLatest))
    return "time: expected seconds since 1970, from 2026 to 2100";
  if (!(request.at <= at && request.at >= at - kOldest)) return "at: not within the last minute";
  return "";
}

}  // namespace adit::clock
