// The next map is packed while the first is in flight.
#include <gtest/gtest.h>

#include <optional>

#include "forward/manual_endpoint.hpp"

namespace adit::forward {
namespace {

class PreparedMap : public MapsToManualEndpoint {
 protected:
  /// The first map is in flight, the second is packed.
  void send_one_and_pack_one() {
    accept(grid_of("first", 10));
    ASSERT_TRUE(receives({"first"}));
    accept(grid_of("second", 10));
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->queued_bytes() == 0 && !maps_->packing(); }));
  }
};

TEST_F(PreparedMap, IsPackedWhileTheFirstIsInFlight) {
  send_one_and_pack_one();
  EXPECT_EQ(post_.received().size(), 1u);
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 1u);
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "second"}), 1u);
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"first", "second"}));
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "first"}), 0u);
}

TEST_F(PreparedMap, ReturnsToTheQueueWithTheFirst) {
  send_one_and_pack_one();
  for (const char* answer : {"500 Oops", "200 OK", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(loop::turn_until(loop_, [&] {
    return maps_->waiting({TrafficKind::Grid, "first"}) + maps_->waiting({TrafficKind::Grid, "second"}) == 0;
  }));
  EXPECT_EQ(post_.received().size(), 3u);
}

TEST_F(PreparedMap, ReturnsToTheQueueIfTheRunChangesWhileItIsPacked) {
  accept(grid_of("first", 10));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->packing(); }));
  maps_->change_run(dispatch::NextMap::MayBeTheSame);
  EXPECT_GT(maps_->queued_bytes(), 0u);
  post_.answer("200 OK");
  EXPECT_TRUE(receives({"first"}));
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return maps_->waiting({TrafficKind::Grid, "first"}) == 0; }));
  EXPECT_EQ(post_.received().size(), 1u);
}

TEST_F(PreparedMap, IsSentIfTheFirstIsRejected) {
  send_one_and_pack_one();
  post_.answer("422 No");
  EXPECT_TRUE(receives({"first", "second"}));
  EXPECT_EQ(rejected_.rows().size(), 1u);
}

/// Otherwise older cells would follow newer ones.
TEST_F(PreparedMap, ReplacesAFailedGridThatItCovers) {
  accept(grid_of("first", 10));
  ASSERT_TRUE(receives({"first"}));
  accept(grid_of("first", 20));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->queued_bytes() == 0 && !maps_->packing(); }));
  post_.answer("500 Oops");
  ASSERT_TRUE(receives({"first", "first"}));
  post_.answer("200 OK");
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return maps_->waiting({TrafficKind::Grid, "first"}) == 0; }));
  EXPECT_EQ(post_.received().size(), 2u);
}

TEST_F(PreparedMap, ReplacesAnOlderGridSentByTheOperator) {
  accept(grid_of("first", 10));
  ASSERT_TRUE(receives({"first"}));
  accept(grid_of("second", 20));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->queued_bytes() == 0; }));
  std::optional<bool> kept;
  maps_->resend(grid_of("second", 10), [&](bool well) {
    kept = well;
    return true;
  });
  EXPECT_EQ(kept, true) << "the newer grid covers it";
  EXPECT_EQ(maps_->waiting({TrafficKind::Grid, "second"}), 1u);
}

}  // namespace
}  // namespace adit::forward
