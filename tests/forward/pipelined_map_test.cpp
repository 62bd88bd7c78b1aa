// The next map is sent on a second connection before the first is answered. The Command Post serves one
// connection at a time.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "forward/manual_endpoint.hpp"

namespace adit::forward {
namespace {

class PipelinedMap : public MapsToManualEndpoint {
 protected:
  /// Delivers enough maps to allow pipelining.
  void deliver_several() {
    for (int i = 0; i < queues::Pipelining::kWell; ++i) {
      post_.answer("200 OK");
      accept(grid_of("first", 10));
      ASSERT_TRUE(are_delivered());
    }
    before_ = post_.received().size();
  }
  bool are_delivered() {
    return loop::turn_until(loop_, [&] { return is_queue_empty(); });
  }
  bool is_queue_empty() const {
    std::size_t waiting = 0;
    for (const char* robot : {"first", "second", "third"}) {
      for (const TrafficKind kind : {TrafficKind::Grid, TrafficKind::Cloud})
        waiting += maps_->waiting({kind, robot});
    }
    return waiting == 0;
  }
  /// True if bytes of the next map leave before the first map is answered. If a busy machine delays the
  /// answer, Adit sends nothing ahead and the caller tries again.
  bool is_sent_ahead(const char* robot, const icd::MapUpdate& next, std::uint32_t width = 10) {
    accept(grid_of(robot, width));
    if (!loop::turn_until(loop_, [&] { return post_.received().size() > before_; })) return false;
    const std::uint64_t sent = maps_->channel().bytes_sent();
    accept(next);
    const loop::Instant late = loop_.now() + queues::Pipelining::kLate;
    return loop::turn_until(loop_,
                            [&] { return maps_->channel().bytes_sent() > sent || loop_.now() > late; }) &&
           maps_->channel().bytes_sent() > sent;
  }
  std::vector<std::string> received_since() {
    auto came = post_.received();
    return {came.begin() + static_cast<std::ptrdiff_t>(before_), came.end()};
  }
  void send_one_ahead() {
    for (int tries = 0; tries < 10; ++tries) {
      deliver_several();
      if (is_sent_ahead("first", grid_of("second", 10))) return;
      for (int i = 0; i < 2; ++i) post_.answer("200 OK");
      ASSERT_TRUE(are_delivered());
    }
    FAIL() << "no map was sent ahead";
  }

  std::size_t before_ = 0;
};

TEST_F(PipelinedMap, IsDeliveredAfterTheFirstMap) {
  send_one_ahead();
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 1u);
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "second"}), 1u);
  for (int i = 0; i < 2; ++i) post_.answer("200 OK");
  EXPECT_TRUE(are_delivered());
  EXPECT_EQ(received_since(), (std::vector<std::string>{"first", "second"}));
}

TEST_F(PipelinedMap, StaysInFlightIfTheFirstFails) {
  send_one_ahead();
  for (const char* answer : {"500 Oops", "200 OK", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(are_delivered());
  EXPECT_EQ(received_since(), (std::vector<std::string>{"first", "second", "first"}));
}

TEST_F(PipelinedMap, IsRetriedIfItFails) {
  send_one_ahead();
  for (const char* answer : {"200 OK", "500 Oops", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(are_delivered());
  EXPECT_EQ(received_since(), (std::vector<std::string>{"first", "second", "second"}));
}

/// The Command Post may have checked the second map first, so that the first one's stamp ran backward.
TEST_F(PipelinedMap, IsNoReasonToLoseTheFirstOne) {
  send_one_ahead();
  for (const char* answer : {"422 stamp: runs backward", "200 OK", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(are_delivered());
  EXPECT_EQ(received_since(), (std::vector<std::string>{"first", "second", "first"}));
  EXPECT_TRUE(rejected_.rows().empty());
}

TEST_F(PipelinedMap, StaysInFlightIfTheFirstIsRejectedAlsoAlone) {
  send_one_ahead();
  for (const char* answer : {"422 No", "200 OK", "422 No"}) post_.answer(answer);
  EXPECT_TRUE(are_delivered());
  EXPECT_EQ(rejected_.rows().size(), 1u);
}

TEST_F(PipelinedMap, WaitsForAnOlderGridOfItsRobot) {
  deliver_several();
  EXPECT_FALSE(is_sent_ahead("first", grid_of("first", 5)));
  for (int i = 0; i < 2; ++i) post_.answer("200 OK");
  EXPECT_TRUE(are_delivered());
}

/// A Command Post that reads both would check the small map first, and stamps would go back.
TEST_F(PipelinedMap, WaitsForALargeMap) {
  deliver_several();
  EXPECT_FALSE(is_sent_ahead("first", grid_of("second", 10), 4000));
  for (int i = 0; i < 2; ++i) post_.answer("200 OK");
  EXPECT_TRUE(are_delivered());
}

TEST_F(PipelinedMap, IsSentToANewEndpointWithTheFirst) {
  send_one_ahead();
  ManualEndpoint other;
  settings_.command_post.mapping = other.address();
  maps_->on_endpoint_changed(icd::BearerToken::parse("a-token"));
  for (int i = 0; i < 2; ++i) other.answer("200 OK");
  EXPECT_TRUE(are_delivered());
  EXPECT_EQ(other.received(), (std::vector<std::string>{"first", "second"}));
  maps_.reset();  // closes the connections that `other` reads
}

}  // namespace
}  // namespace adit::forward
