#include "pace/delivery.hpp"

#include <algorithm>
#include <utility>

namespace adit::pace {

std::uint64_t map_bytes_per_second(double megabit) {
  constexpr double kWireBytes = 1e6 / 8;        // a second, for each Mbit/s
  constexpr double kPayload = 1448.0 / 1538.0;  // of a full TCP frame with time stamps, preamble and gap
  constexpr double kForMaps = 0.98;             // the rest is for reports, states, markers and ACKs
  constexpr double kMostMegabit = 1e6;
  const double bytes = std::min(megabit, kMostMegabit) * kWireBytes * kPayload * kForMaps;
  return std::max<std::uint64_t>(1, static_cast<std::uint64_t>(bytes));
}

namespace {

using Seconds = std::chrono::duration<double>;

constexpr double kMore = 1.25, kLess = 0.5;
/// Parts of the pace. A lower delivery rate shows a growing queue, a higher one a shrinking queue.
constexpr double kKept = 0.9, kNearly = 0.98, kDrawn = 1.1;
/// A probe succeeds above this multiple of the known rate.
constexpr double kFound = 1.05;
/// A round trip that is at least this much longer than the shortest one shows a queue.
constexpr std::chrono::milliseconds kQueue{5};
/// After this many intervals with a queue, even a rate just below the pace is the rate of the link.
constexpr int kStands = 4;
/// A shorter interval gives no reliable rate.
constexpr std::chrono::milliseconds kTelling{20};

/// Bytes. If TCP has no more to send although Adit writes all the time, far more are in flight.
constexpr std::size_t kFew = 64u << 10;

/// TCP has too little to send, so the link may carry more.
bool is_starved(const Progress& now) {
  return now.unsent == 0 && now.in_flight < kFew;
}

bool has_queue(const Progress& now) {
  return now.round_trip > now.least_round_trip + std::max<Duration>(kQueue, now.least_round_trip / 4);
}

}  // namespace

void Delivery::on_write_begun(const Progress& now) {
  began_ = now;
  queued_ = has_queue(now);
  starved_ = false;
}

void Delivery::on_write(const Progress& now) {
  const bool has = has_queue(now);
  if (probes_ && has && !has_queue(began_)) return queue_ended_probe(now);
  if (drains_ && !has) {
    drains_ = false;
    return on_write_begun(now);
  }
  queued_ = queued_ && has;
  starved_ = starved_ || is_starved(now);
  if (now.at - began_.at < std::max<Duration>(kInterval, 2 * now.least_round_trip)) return;
  const double rate = measured_rate(now);
  if (rate > 0 && (!starved_ || rate > link_ * kFound)) measure(rate, now.at);
  if (!drains_ && link_ < most_ && now.at >= probe_at_) probes_ = true;
  on_write_begun(now);
}

double Delivery::measured_rate(const Progress& now) const {
  const auto bytes = now.delivered - std::min(began_.delivered, now.delivered);
  return static_cast<double>(bytes) / Seconds(now.at - began_.at).count();
}

/// The link was full until now.
void Delivery::queue_ended_probe(const Progress& now) {
  if (!starved_ && now.at - began_.at >= kTelling) link_ = std::clamp(measured_rate(now), link_, most_);
  end_probe(true, now.at);
  on_write_begun(now);
}

void Delivery::measure(double rate, Instant now) {
  remember(rate, now);
  const double given = pace();
  stands_ = queued_ ? stands_ + 1 : 0;
  if (probes_) {
    const bool found = rate > link_ * kFound;
    link_ = std::clamp(rate, link_, most_);
    end_probe(!found, now);
  } else if (queued_ && rate < given * kKept) {
    set_rate(rate, now);
    drains_ = true;
  } else if (drains_) {  // a round trip that is long for another reason drains no bytes
    if (rate > given * kDrawn) set_rate(rate, now);
    drains_ = rate > given * kDrawn;
  } else if (stands_ >= kStands) {
    if (rate < given * kNearly) set_rate(rate, now);
    drains_ = true;
    stands_ = 0;
  }
}

/// A queue existed during the whole interval, so `rate` is the rate of the link. A short disturbance looks
/// like a slower link, so the next probe comes soon.
void Delivery::set_rate(double rate, Instant now) {
  const double before = std::exchange(link_, std::clamp(rate, most_ * kSlowest, most_));
  if (link_ > before * kKept) return;
  most_before_ = 0;
  most_now_ = rate;
  wait_ = kFirstWait;
  probe_at_ = now;
}

void Delivery::remember(double rate, Instant now) {
  if (now - second_began_ >= kRemembered) {
    most_before_ = std::exchange(most_now_, 0);
    second_began_ = now;
  }
  most_now_ = std::max(most_now_, rate);
}

void Delivery::end_probe(bool in_vain, Instant now) {
  probes_ = false;
  if (!in_vain) {
    wait_ = kFirstWait;
    return;
  }
  probe_at_ = now + wait_;
  wait_ = std::min<Duration>(wait_ * 2, kLongestWait);
}

double Delivery::pace() const {
  if (link_ >= most_) return most_;
  if (drains_) return link_ * kLess;
  return probes_ ? std::min(link_ * kMore, most_) : link_;
}

double Delivery::delivery_rate() const {
  const double seen = std::max(most_before_, most_now_);
  return seen > 0 ? std::min(seen, most_) : most_;
}

}  // namespace adit::pace
