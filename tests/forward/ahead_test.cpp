// The next map goes ahead of the answer to the one before, on a second connection, to a Command Post that
// serves one connection at a time.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "forward/letting_post.hpp"

namespace adit::forward {
namespace {

class MapAhead : public WithLettingPost {
 protected:
  /// The Command Post has taken enough maps to be trusted.
  void has_answered_well() {
    for (int i = 0; i < queues::Pipelining::kWell; ++i) {
      post_.answer("200 OK");
      take(grid_of("first", 10));
      ASSERT_TRUE(are_gone());
    }
    before_ = post_.came().size();
  }
  bool are_gone() {
    return loop::turn_until(loop_, [&] { return nothing_waits(); });
  }
  bool nothing_waits() const {
    std::size_t waiting = 0;
    for (const char* robot : {"first", "second", "third"}) {
      for (const Kind kind : {Kind::Grid, Kind::Cloud}) waiting += maps_->waiting({kind, robot});
    }
    return waiting == 0;
  }
  /// Of the second map, once it follows the first one: whether bytes of it have left before that is answered.
  /// On a machine so busy that the answer is called late, nothing goes ahead: then once more.
  bool goes_ahead(const char* robot, const icd::MapUpdate& next, std::uint32_t width = 10) {
    take(grid_of(robot, width));
    if (!loop::turn_until(loop_, [&] { return post_.came().size() > before_; })) return false;
    const std::uint64_t sent = maps_->channel().bytes_sent();
    take(next);
    const loop::Instant late = loop_.now() + queues::Pipelining::kLate;
    return loop::turn_until(loop_,
                            [&] { return maps_->channel().bytes_sent() > sent || loop_.now() > late; }) &&
           maps_->channel().bytes_sent() > sent;
  }
  std::vector<std::string> came_since() {
    auto came = post_.came();
    return {came.begin() + static_cast<std::ptrdiff_t>(before_), came.end()};
  }
  void one_is_ahead() {
    for (int tries = 0; tries < 10; ++tries) {
      has_answered_well();
      if (goes_ahead("first", grid_of("second", 10))) return;
      for (int i = 0; i < 2; ++i) post_.answer("200 OK");
      ASSERT_TRUE(are_gone());
    }
    FAIL() << "ten times";
  }

  std::size_t before_ = 0;
};

TEST_F(MapAhead, IsTakenOnceTheOneBeforeIsAnswered) {
  one_is_ahead();
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 1u);
  EXPECT_EQ(maps_->waiting({Kind::Grid, "second"}), 1u);
  for (int i = 0; i < 2; ++i) post_.answer("200 OK");
  EXPECT_TRUE(are_gone());
  EXPECT_EQ(came_since(), (std::vector<std::string>{"first", "second"}));
}

TEST_F(MapAhead, StaysUnderWayWhereTheOneBeforeFails) {
  one_is_ahead();
  for (const char* answer : {"500 Oops", "200 OK", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(are_gone());
  EXPECT_EQ(came_since(), (std::vector<std::string>{"first", "second", "first"}));
}

TEST_F(MapAhead, IsSentAgainWhereItFails) {
  one_is_ahead();
  for (const char* answer : {"200 OK", "500 Oops", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(are_gone());
  EXPECT_EQ(came_since(), (std::vector<std::string>{"first", "second", "second"}));
}

TEST_F(MapAhead, StaysUnderWayWhereTheOneBeforeIsRefused) {
  one_is_ahead();
  for (const char* answer : {"422 No", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(are_gone());
  EXPECT_EQ(rejected_.rows().size(), 1u);
}

TEST_F(MapAhead, GoesNotAheadOfAnOlderGridOfItsRobot) {
  has_answered_well();
  EXPECT_FALSE(goes_ahead("first", grid_of("first", 5)));
  for (int i = 0; i < 2; ++i) post_.answer("200 OK");
  EXPECT_TRUE(are_gone());
}

/// A Command Post that reads both at once would check the small one first: the other one's stamp would run
/// backward.
TEST_F(MapAhead, GoesNotAheadOfALargeMapThatMayStillBeRead) {
  has_answered_well();
  EXPECT_FALSE(goes_ahead("first", grid_of("second", 10), 4000));
  for (int i = 0; i < 2; ++i) post_.answer("200 OK");
  EXPECT_TRUE(are_gone());
}

TEST_F(MapAhead, BothAreGivenUpWhereTheEndpointIsAnother) {
  one_is_ahead();
  LettingPost other;
  settings_.command_post.mapping = other.address();
  maps_->endpoint_changed(icd::BearerToken::parse("a-token"));
  for (int i = 0; i < 2; ++i) other.answer("200 OK");
  EXPECT_TRUE(are_gone());
  EXPECT_EQ(other.came(), (std::vector<std::string>{"first", "second"}));
  maps_.reset();  // else the other one waits for more
}

}  // namespace
}  // namespace adit::forward
