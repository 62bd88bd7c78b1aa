#include "forward/slot.hpp"

#include <algorithm>
#include <array>

namespace adit::forward {
namespace {

using Seconds = std::chrono::duration<double>;

/// What shorter messages show of the link is little more than its delay.
constexpr std::size_t kTelling = 64u << 10;
/// So much at least, so that a link that was slow is found to be fast again.
constexpr double kLeast = 4.0 * kTelling;
/// What rounding makes of a cloud's bytes at each precision, as measured by tests/bench/sizes.
constexpr std::array<double, 3> kOfExact{1, 0.65, 0.5};
constexpr double kSmallest = 0.01;  // that packing is expected to make of a byte
constexpr std::chrono::milliseconds kHeldBack{20};
/// Of the limit, because clouds do not all pack alike.
constexpr double kOfLimit = 0.9;

}  // namespace

void Slot::allow(std::uint64_t most) {
  most_ = bytes_per_second_ = static_cast<double>(most);
}

/// A longer time counts at once. Of its excess over shorter ones, a third is left after eight of them.
void Slot::on_packing_done(loop::Duration took) {
  packing_takes_ = std::max(took, packing_takes_ - (packing_takes_ - took) / 8);
}

void Slot::on_packed(std::size_t points, std::size_t bytes, queues::Precision precision) {
  if (points < kTelling) return;
  const double packed_to = static_cast<double>(bytes) / static_cast<double>(points);
  packed_to_ = std::clamp(packed_to / kOfExact.at(static_cast<std::size_t>(precision)), kSmallest, 1.0);
}

/// Bytes that were held back give only a lower limit of the speed.
void Slot::on_sent(std::size_t bytes, const uplink::SendTimes& sent, loop::Instant last_byte_not_before) {
  if (bytes < kTelling) return;
  const double took = std::max(Seconds(sent.last - sent.first).count(), 1e-6);
  const double seen = std::min(static_cast<double>(bytes) / took, most_);
  const bool was_held_back = sent.last <= last_byte_not_before + kHeldBack;
  bytes_per_second_ = was_held_back ? std::max(seen, bytes_per_second_) : seen;
}

/// Small maps are ignored, because their times vary, and many grids take far less time than expected. After
/// each map that was not compressed, the box counts as a little less slow, so that Adit forgets a stall.
void Slot::on_work_done(loop::Duration took, double expected) {
  constexpr double kLeastExpected = 0.5e-3, kFastest = 0.5, kSlowest = 100;
  constexpr double kForgets = 1.0 / 32;
  if (expected == 0 && slowness_ > 1) slowness_ -= (slowness_ - 1) * kForgets;
  if (expected < kLeastExpected) return;
  slowness_ = std::clamp((slowness_ + Seconds(took).count() / expected) / 2, kFastest, kSlowest);
}

pack::EffortInput Slot::effort_input(loop::Duration spacing) const {
  return {.bytes_per_second = bytes_per_second_, .slowness = slowness_, .longest = Seconds(spacing).count()};
}

void Slot::set_link_rate(std::uint64_t bytes_per_second) {
  if (bytes_per_second == 0) return;
  bytes_per_second_ = std::min(bytes_per_second_, static_cast<double>(bytes_per_second));
}

void Slot::on_passed(std::size_t bytes) {
  largest_ = std::max(largest_, bytes);
  limit_ = std::max(limit_, bytes);
  ++smaller_;
}

/// If a larger message has passed, this one's sender alone has a limit.
void Slot::on_too_large(std::size_t bytes) {
  smaller_ = 0;
  if (bytes > largest_) limit_ = std::min(limit_, std::max(largest_, bytes / 2));
}

loop::Duration Slot::transfer(std::size_t bytes) const {
  return std::chrono::duration_cast<loop::Duration>(Seconds(static_cast<double>(bytes) / bytes_per_second_));
}

queues::PointsAt Slot::points_for(loop::Duration spacing) const {
  const double leave = std::max(bytes_per_second_ * Seconds(spacing).count(), kLeast);
  const double bytes = std::min(leave, kOfLimit * static_cast<double>(limit()));
  constexpr double kMost = 1e15;
  queues::PointsAt points{};
  std::ranges::transform(kOfExact, points.begin(), [&](double of_exact) {
    return static_cast<std::size_t>(std::min(bytes / (packed_to_ * of_exact), kMost));
  });
  return points;
}

}  // namespace adit::forward
