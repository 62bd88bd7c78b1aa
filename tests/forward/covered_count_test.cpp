#include "forward/covered_count.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "loop/turn_until.hpp"
#include "picture/maps.hpp"

namespace adit::forward {
namespace {

class CoveredCountTest : public testing::Test {
 protected:
  void ask() {
    count.covered([this](const auto& covered) { answers.push_back(covered ? covered->all : 0); });
  }
  void draw(double x) { easel.draw(picture::grid_at(x, 0, 2, 0.25, picture::Cells(4, 0))); }
  /// True if there are so many answers.
  bool answered(std::size_t wanted) {
    return loop::turn_until(loop, [&] { return answers.size() == wanted; });
  }

  loop::Loop loop;
  loop::Workers workers{loop, 1};
  picture::Easel easel;
  CoveredCount count{workers, easel.mosaic};
  std::vector<std::uint64_t> answers;  // pixels; 0: an error
};

TEST_F(CoveredCountTest, AnswersWithTheMapAsItIs) {
  draw(0);
  ask();
  draw(10);
  ask();  // the first count is in progress
  ASSERT_TRUE(answered(2));
  EXPECT_EQ(answers, (std::vector<std::uint64_t>{4, 8}));
}

TEST_F(CoveredCountTest, RejectsRequestsBeyondTheLimit) {
  draw(0);
  for (std::size_t i = 0; i < CoveredCount::kMostAskers + 2; ++i) ask();
  EXPECT_EQ(answers, std::vector<std::uint64_t>{0}) << "the first one is being counted, the last is rejected";
  ASSERT_TRUE(answered(CoveredCount::kMostAskers + 2));
  EXPECT_EQ(answers.back(), 4);
}

}  // namespace
}  // namespace adit::forward
