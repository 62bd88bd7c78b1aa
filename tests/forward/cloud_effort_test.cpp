// A cloud is packed only if that saves time.
#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

#include "forward/manual_endpoint.hpp"
#include "forward/sample_maps.hpp"
#include "forward/stitched.hpp"

namespace adit::forward {
namespace {

/// Noise that packs a little smaller.
icd::MapUpdate large_cloud(const char* robot) {
  std::mt19937 random(1);
  std::vector<float> numbers(120'000);
  for (float& number : numbers) number = std::uniform_real_distribution<float>(0, 100)(random);
  std::vector<std::uint8_t> bytes(numbers.size() * sizeof numbers[0]);
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  icd::MapUpdate cloud = cloud_along_x(robot, {});
  cloud.data = {icd::ChunkedBytes{bytes}, icd::Compression::None, bytes.size()};
  return cloud;
}

queues::QueuedMap waiting(icd::MapUpdate map, queues::Precision precision = queues::Precision::Exact) {
  queues::QueuedMap waiting;
  waiting.map = std::move(map);
  waiting.precision = precision;
  return waiting;
}

constexpr pack::EffortInput kFast{.bytes_per_second = 1e10, .slowness = 1, .longest = 1},
    kMedium{.bytes_per_second = 6e7, .slowness = 1, .longest = 1},
    kSlow{.bytes_per_second = 1e5, .slowness = 1, .longest = 1};

TEST(CloudEffort, IsNoneOnAFastLink) {
  const icd::MapUpdate cloud = large_cloud("r1");
  const PackedMap hurried = pack_map(waiting(cloud), {.hurry = kFast});
  EXPECT_EQ(hurried.effort, pack::Effort::None);
  EXPECT_GE(hurried.body.size(), cloud.data.bytes.size());
}

TEST(CloudEffort, EstimatesThePackedSize) {
  const icd::MapUpdate cloud = large_cloud("r1");
  const PackedMap full = pack_map(waiting(cloud)), hurried = pack_map(waiting(cloud), {.hurry = kMedium});
  ASSERT_EQ(hurried.effort, pack::Effort::None);
  EXPECT_EQ(full.full_size, full.body.size());
  EXPECT_NEAR(static_cast<double>(hurried.full_size), static_cast<double>(full.full_size),
              0.2 * static_cast<double>(full.full_size));
}

TEST(CloudEffort, IsFullOnASlowLink) {
  const icd::MapUpdate cloud = large_cloud("r1");
  const PackedMap hurried = pack_map(waiting(cloud), {.hurry = kSlow});
  EXPECT_EQ(hurried.effort, pack::Effort::Full);
  EXPECT_EQ(hurried.body, pack_map(waiting(cloud)).body);
}

TEST(CloudEffort, RoundsAsRequested) {
  const icd::MapUpdate cloud = large_cloud("r1");
  for (const auto precision : {queues::Precision::Millimetre, queues::Precision::EightMillimetres}) {
    const PackedMap hurried = pack_map(waiting(cloud, precision), {.hurry = kFast});
    EXPECT_EQ(hurried.body, pack_map(waiting(cloud, precision)).body);
    EXPECT_EQ(hurried.precision, precision);
  }
}

class CloudOnAFastLink : public MapsToManualEndpoint {
 protected:
  CloudOnAFastLink() {
    settings_.command_post.rates.map_hz = 10;
    settings_.command_post.budget_mbit = 100'000;
    maps_->on_settings_changed();
    maps_->on_endpoint_changed(icd::BearerToken::parse("a-token"));  // the link gets the budget
  }
  std::uint64_t sent(const char* robot) const {
    const auto found = counts_.rows().find({TrafficKind::Cloud, robot});
    return found == counts_.rows().end() ? 0 : found->second.bytes_sent;
  }
};

/// The link may look slow on a busy machine. Then the test tries again.
TEST_F(CloudOnAFastLink, IsSentUnpackedAfterWaiting) {
  const icd::MapUpdate cloud = large_cloud("second");
  for (std::size_t tries = 1; tries <= 20 && sent("second") < cloud.data.bytes.size(); ++tries) {
    const std::size_t before = post_.received().size();
    accept(grid_of("first", 10));
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return post_.received().size() > before; }));
    accept(cloud);
    for (int i = 0; i < 2; ++i) post_.answer("200 OK");
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->waiting({TrafficKind::Cloud, "second"}) == 0; }));
  }
  EXPECT_GT(sent("second"), cloud.data.bytes.size());
}

}  // namespace
}  // namespace adit::forward
