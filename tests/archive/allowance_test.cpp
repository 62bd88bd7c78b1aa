#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "archive/write_queue.hpp"

namespace adit::archive {
namespace {

using namespace std::chrono_literals;

TEST(Allowance, NeverExceedsAMegabyteAMinute) {
  std::mt19937 random{7};
  for (int day = 0; day < 50; ++day) {
    Allowance allowance;
    loop::Instant now{1h};
    std::deque<std::pair<loop::Instant, std::size_t>> last_minute;
    std::size_t in_it = 0;
    for (int i = 0; i < 2000; ++i) {
      now += std::chrono::milliseconds{random() % 8000};
      const std::size_t may = allowance.at(now), spent = random() % 3 == 0 ? may : may / (1 + random() % 9);
      allowance.spend(spent);
      last_minute.emplace_back(now, spent);
      in_it += spent;
      for (; last_minute.front().first < now - 1min; last_minute.pop_front())
        in_it -= last_minute.front().second;
      ASSERT_LT(in_it, 1'000'000U) << "day " << day;
    }
  }
}

TEST(Allowance, AllowsTheLargestRecord) {
  Allowance allowance;
  loop::Instant now{1h};
  EXPECT_GE(allowance.at(now), kLargestRecord);
  allowance.spend(allowance.at(now));
  EXPECT_EQ(allowance.at(now), 0U);
  EXPECT_GE(allowance.at(now + 10s), kLargestRecord);
}

TEST(Allowance, IsRepaidAfterOverspending) {
  Allowance allowance;
  loop::Instant now{1h};
  allowance.spend(allowance.at(now) + static_cast<std::size_t>(Allowance::kASecond));
  EXPECT_EQ(allowance.at(now + 500ms), 0U);
  EXPECT_GT(allowance.at(now + 2s), 0U);
}

}  // namespace
}  // namespace adit::archive
