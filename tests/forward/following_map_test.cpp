// The next map is packed while one is under way, and goes back with it.
#include <gtest/gtest.h>

#include <optional>

#include "forward/letting_post.hpp"

namespace adit::forward {
namespace {

class FollowingMap : public WithLettingPost {
 protected:
  /// One is under way, and one is packed.
  void two_are_out_of_the_queue() {
    take(grid_of("first", 10));
    ASSERT_TRUE(come({"first"}));
    take(grid_of("second", 10));
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->queued_bytes() == 0 && !maps_->packing(); }));
  }
};

TEST_F(FollowingMap, IsPackedWhileTheOneBeforeIsUnderWay) {
  two_are_out_of_the_queue();
  EXPECT_EQ(post_.came().size(), 1u);
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 1u);
  EXPECT_EQ(maps_->waiting({Kind::Grid, "second"}), 1u);
  post_.answer("200 OK");
  EXPECT_TRUE(come({"first", "second"}));
  EXPECT_EQ(maps_->waiting({Kind::Grid, "first"}), 0u);
}

TEST_F(FollowingMap, GoesBackWithTheOneBefore) {
  two_are_out_of_the_queue();
  for (const char* answer : {"500 Oops", "200 OK", "200 OK"}) post_.answer(answer);
  EXPECT_TRUE(loop::turn_until(loop_, [&] {
    return maps_->waiting({Kind::Grid, "first"}) + maps_->waiting({Kind::Grid, "second"}) == 0;
  }));
  EXPECT_EQ(post_.came().size(), 3u);
}

TEST_F(FollowingMap, GoesWhereTheOneBeforeIsRefused) {
  two_are_out_of_the_queue();
  post_.answer("422 No");
  EXPECT_TRUE(come({"first", "second"}));
  EXPECT_EQ(rejected_.rows().size(), 1u);
}

/// Else the newer grid, which covers the older one, would be followed by its old cells.
TEST_F(FollowingMap, TakesThePlaceOfTheOneBeforeThatComesBackAndThatItCovers) {
  take(grid_of("first", 10));
  ASSERT_TRUE(come({"first"}));
  take(grid_of("first", 20));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->queued_bytes() == 0 && !maps_->packing(); }));
  post_.answer("500 Oops");
  ASSERT_TRUE(come({"first", "first"}));
  post_.answer("200 OK");
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return maps_->waiting({Kind::Grid, "first"}) == 0; }));
  EXPECT_EQ(post_.came().size(), 2u);
}

TEST_F(FollowingMap, SaysWhatIsSentAgainByHand) {
  take(grid_of("first", 10));
  ASSERT_TRUE(come({"first"}));
  take(grid_of("second", 20));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->queued_bytes() == 0; }));
  std::optional<bool> kept;
  maps_->send_again(grid_of("second", 10), [&](bool well) {
    kept = well;
    return true;
  });
  EXPECT_EQ(kept, true) << "the newer one says all of it";
  EXPECT_EQ(maps_->waiting({Kind::Grid, "second"}), 1u);
}

}  // namespace
}  // namespace adit::forward
