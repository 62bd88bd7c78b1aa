#include <gtest/gtest.h>

#include "forward/flow.hpp"

namespace adit::forward {
namespace {

using std::chrono::milliseconds;

class EndingTest : public testing::Test {
 protected:
  EndingTest() { ending_.begin(began_); }
  loop::Instant after(milliseconds time) const { return began_ + time; }

  const loop::Instant began_{std::chrono::seconds{100}};
  Ending ending_;
};

TEST_F(EndingTest, BeginsOnRequest) {
  EXPECT_FALSE(Ending().has_begun());
  EXPECT_TRUE(ending_.has_begun());
}

TEST_F(EndingTest, DismissesAtOnceIfNothingIsInFlight) {
  EXPECT_TRUE(ending_.dismisses(began_, true, true));
  EXPECT_TRUE(ending_.is_over(began_));
}

TEST_F(EndingTest, WaitsForAnswersWithinTheirTime) {
  EXPECT_FALSE(ending_.dismisses(after(Ending::kAnswers - milliseconds{1}), false, true));
  EXPECT_FALSE(ending_.is_over(after(Ending::kAnswers)));
  EXPECT_TRUE(ending_.dismisses(after(Ending::kAnswers), false, true));
}

TEST_F(EndingTest, WaitsLongerForWrites) {
  EXPECT_FALSE(ending_.dismisses(after(Ending::kAnswers), true, false));
  const milliseconds longest = Ending::kAnswers + Ending::kKeepWithin;
  EXPECT_FALSE(ending_.dismisses(after(longest - milliseconds{1}), true, false));
  EXPECT_TRUE(ending_.dismisses(after(longest), true, false));
}

TEST_F(EndingTest, IsOverEvenIfClientsNeverLeave) {
  const milliseconds latest = Ending::kAnswers + 2 * Ending::kKeepWithin;
  EXPECT_FALSE(ending_.is_over(after(latest - milliseconds{1})));
  EXPECT_TRUE(ending_.is_over(after(latest)));
}

}  // namespace
}  // namespace adit::forward
