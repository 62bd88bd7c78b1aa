// Clouds of a robot with robots[].voxel_metres.
#include <gmock/gmock.h>

#include <atomic>
#include <mutex>
#include <optional>
#include <semaphore>
#include <string>
#include <vector>

#include "../uplink/peer.hpp"
#include "forward/fixtures.hpp"
#include "forward/sample_maps.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using testing::ElementsAre;
using Points = std::vector<float>;

/// Answers 200 unless says() names another status. After waits() it answers once go_on() is called.
class SlowEndpoint {
 public:
  ~SlowEndpoint() {
    over_ = true;
    go_on();
  }
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }
  void says(std::string status) {
    const std::lock_guard lock(mutex_);
    next_ = std::move(status);
  }
  void waits() { waits_ = true; }
  void go_on() {
    waits_ = false;
    go_on_.release();
  }

  std::atomic<int> came = 0;

 private:
  void serve(uplink::Wire& wire) {
    while (!wire.read_request().empty()) {
      ++came;
      if (waits_) go_on_.acquire();
      if (over_ || !wire.write(uplink::answer(status(), "null"))) return;
    }
  }
  std::string status() {
    const std::lock_guard lock(mutex_);
    return std::exchange(next_, "200 OK");
  }

  std::mutex mutex_;
  std::string next_ = "200 OK";
  std::atomic<bool> over_ = false, waits_ = false;
  std::counting_semaphore<> go_on_{0};
  uplink::ListeningPeer peer_{[this](uplink::Wire& wire) { serve(wire); }};
};

class LeftOutPoints : public testing::Test, protected MapsParts {
 protected:
  LeftOutPoints() {
    settings_.command_post.rates.map_hz = 1000;
    settings_.command_post.mapping = post_.address();
    settings_.robots = {{.name = "r1", .alias = "", .voxel_metres = 0.5}};
    maps_.emplace(loop_, servers_, workers_, writer_, spool_, settings_, token_, counts_, rejected_, random_,
                  journal_, [this](const icd::MapUpdate& map) { taken_.push_back(xs_of(map.data)); });
  }
  void take(const Points& xs) {
    bool told = false;
    maps_->take(cloud_along_x("r1", xs), {.bytes = 10}, nullptr, [&](const icd::Checked<void>& said) {
      EXPECT_TRUE(said);
      told = true;
    });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return told; }));
  }
  bool are_delivered() {
    return loop::turn_until(loop_, [&] { return maps_->waiting(kClouds) == 0; });
  }
  void arrive(const Points& xs) {
    take(xs);
    ASSERT_TRUE(are_delivered());
  }
  const api::ActivityRow& row() const { return counts_.rows().at(kClouds); }

  const Traffic kClouds{Kind::Cloud, "r1"};
  const std::optional<icd::BearerToken> token_ = icd::BearerToken::parse("a-token");
  SlowEndpoint post_;
  std::vector<Points> taken_;
  std::optional<Maps> maps_;
};

TEST_F(LeftOutPoints, LieInDeliveredVoxels) {
  arrive({0.1F, 0.2F, 1.1F});
  arrive({0.3F, 2.1F});
  EXPECT_THAT(taken_, ElementsAre(Points{0.1F, 1.1F}, Points{2.1F}));
  EXPECT_EQ(row().points_left_out, 2);
}

TEST_F(LeftOutPoints, CanBeAllOfACloud) {
  arrive({0.1F});
  arrive({0.2F});
  EXPECT_EQ(post_.came, 1);
  EXPECT_EQ(row().forwarded, 1);
  EXPECT_EQ(row().replaced, 1);
  EXPECT_EQ(row().points_left_out, 1);
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_TRUE(spool_.read().empty());
}

TEST_F(LeftOutPoints, AreNoneAfterAFailure) {
  post_.says("500 Oops");
  post_.waits();
  take({0.1F});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return post_.came == 1; }));
  take({0.2F});
  post_.go_on();
  ASSERT_TRUE(are_delivered());
  EXPECT_FALSE(taken_.empty()) << "one of the two is enough";
}

TEST_F(LeftOutPoints, AreNoneInANewRun) {
  arrive({0.1F});
  maps_->change_run(dispatch::NextMap::Empty);
  arrive({0.2F});
  EXPECT_THAT(taken_, ElementsAre(Points{0.1F}, Points{0.2F}));
}

TEST_F(LeftOutPoints, AreNoneAtAnotherEndpoint) {
  arrive({0.1F});
  maps_->endpoint_changed(token_);
  arrive({0.2F});
  EXPECT_EQ(taken_.size(), 2);
}

TEST_F(LeftOutPoints, AreSentIfANewRunBeginsMeanwhile) {
  arrive({0.1F});
  post_.waits();
  take({0.2F, 5});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return post_.came == 2; }));
  maps_->change_run(dispatch::NextMap::Empty);
  post_.go_on();
  ASSERT_TRUE(are_delivered());
  EXPECT_THAT(taken_, ElementsAre(Points{0.1F}, Points{0.2F, 5}));
}

TEST_F(LeftOutPoints, AreNoneIfTheSettingIsOff) {
  settings_.robots.clear();
  maps_->settings_changed();
  arrive({0.1F});
  arrive({0.1F});
  EXPECT_EQ(taken_.size(), 2);
}

}  // namespace
}  // namespace adit::forward
