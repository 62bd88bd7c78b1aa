#include <gtest/gtest.h>

#include "intake/client.hpp"

namespace adit::intake {
namespace {

using namespace std::chrono_literals;

constexpr loop::Instant kStart{100h};

/// Moves `bytes` every `every` for `total`. Returns when the rate is too slow, or nothing.
std::optional<loop::Duration> too_slow_after(std::uint64_t bytes, loop::Duration every,
                                             loop::Duration total) {
  LeastRate rate(10s, kStart);
  for (loop::Duration passed{}; passed < total; passed += 100ms) {
    if (kStart + passed >= rate.next_check() && rate.is_too_slow(kStart + passed)) return passed;
    if (passed % every == 0ns) rate.count_bytes(bytes);
  }
  return std::nullopt;
}

TEST(LeastRate, AllowsASlowRadioForAnHour) {
  EXPECT_FALSE(too_slow_after(1100, 1s, 1h));
}

TEST(LeastRate, AllowsABurstyRadioForAnHour) {
  EXPECT_FALSE(too_slow_after(12'000, 5s, 1h));
}

TEST(LeastRate, DetectsAByteEachTenSeconds) {
  EXPECT_EQ(too_slow_after(1, 10s, 1h), 10s);
}

TEST(LeastRate, DetectsAClientThatIsALittleTooSlow) {
  EXPECT_EQ(too_slow_after(900, 1s, 1h), 10s);
}

TEST(LeastRate, DetectsAStopAfterAnyAmount) {
  LeastRate rate(10s, kStart);
  rate.count_bytes(1'000'000);
  EXPECT_FALSE(rate.is_too_slow(kStart + 5s));
  EXPECT_FALSE(rate.is_too_slow(kStart + 10s));
  EXPECT_TRUE(rate.is_too_slow(kStart + 15s));
}

TEST(LeastRate, IsCheckedAgainHalfAWindowLater) {
  LeastRate rate(10s, kStart);
  EXPECT_EQ(rate.next_check(), kStart + 5s);
  EXPECT_FALSE(rate.is_too_slow(kStart + 6s)) << "half a window is too short";
  EXPECT_EQ(rate.next_check(), kStart + 11s);
}

}  // namespace
}  // namespace adit::intake
