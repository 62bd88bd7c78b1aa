// A proxy before the mapping endpoint answers 413 with a web page to a body above its limit.
#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <filesystem>
#include <limits>
#include <mutex>
#include <random>
#include <set>
#include <thread>

#include "../uplink/peer.hpp"
#include "codec/body_decoder.hpp"
#include "codec/bytes_of.hpp"
#include "codec/gzip.hpp"
#include "codec/read.hpp"
#include "forward/fixtures.hpp"
#include "forward/sample_maps.hpp"
#include "loop/turn_until.hpp"

namespace adit::forward {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr std::size_t kLimit = 300'000;
constexpr const char* kPage = "<html>too large</html>";
constexpr int kPoints = 8000, kClouds = 10;  // a cloud has about 80 kB

class ProxyStub {
 public:
  /// `body`: of the answer; null: a reset once kLimit bytes have arrived.
  explicit ProxyStub(const char* body, const char* status = "413 Request Entity Too Large")
      : body_(body), status_(status) {}
  settings::Address address() const { return {peer_.endpoint().address, peer_.endpoint().port}; }
  /// The x of each accepted point.
  std::multiset<float> points() {
    const std::lock_guard lock(mutex_);
    return points_;
  }
  struct Rows {
    icd::OccupancyGrid grid;
    std::vector<std::uint8_t> cells;
  };
  /// The accepted grids, in the order in which they arrived.
  std::vector<Rows> grids() {
    const std::lock_guard lock(mutex_);
    return grids_;
  }
  /// Another run begins.
  void forget() {
    const std::lock_guard lock(mutex_);
    points_.clear();
  }
  std::atomic<int> too_large = 0;
  std::atomic<bool> has_empty_cloud = false;

 private:
  void serve(uplink::Wire& wire) {
    for (std::string head = wire.read_head(); !head.empty(); head = wire.read_head()) {
      const bool fits = std::stoul(head.substr(head.find(kLength) + kLength.size())) <= kLimit;
      if (!fits) ++too_large;
      if (!fits && body_ == nullptr) {
        for (std::size_t came = 0, some = 1; came < kLimit && some > 0; came += some)
          some = wire.read_some(kLimit - came);
        return wire.reset();
      }
      const std::string request = wire.read_rest(head);
      if (request.empty()) return;
      if (fits) note(request.substr(head.size()));
      if (!wire.write(fits ? uplink::answer("200 OK", "null") : uplink::answer(status_, body_))) return;
    }
  }
  void note(const std::string& body) {
    auto document = codec::decode({codec::Format::Cbor, {}}, codec::Split::MapData, body);
    ASSERT_TRUE(document);
    const auto map = codec::read_map_update(*std::move(document), {});
    ASSERT_TRUE(map);
    if (map->is_grid()) {
      const std::lock_guard lock(mutex_);
      grids_.push_back({std::get<icd::OccupancyGrid>(map->msg), codec::bytes_of(map->data)});
      return;
    }
    const auto xs = xs_of(map->data);
    if (xs.empty()) has_empty_cloud = true;
    const std::lock_guard lock(mutex_);
    points_.insert(xs.begin(), xs.end());
  }
  std::mutex mutex_;
  std::multiset<float> points_;
  std::vector<Rows> grids_;
  static constexpr std::string_view kLength = "Content-Length: ";
  const char *body_, *status_;
  std::vector<std::jthread> connections_;
  uplink::ListeningPeer peer_{std::vector<uplink::Peer::Script>{[this](uplink::Wire& wire) {
    connections_.emplace_back([this, its = std::move(wire)]() mutable { serve(its); });
  }}};
};

class TooLargeMap : public testing::Test, protected MapsParts {
 protected:
  TooLargeMap() { settings_.command_post.rates.map_hz = 100; }

  /// The maps are queued before the first one is sent.
  void send(const std::vector<icd::MapUpdate>& updates, const char* body = kPage,
            const char* status = "413 Request Entity Too Large") {
    proxy_.emplace(body, status);
    settings_.command_post.mapping = proxy_->address();
    std::size_t taken = 0;
    for (const icd::MapUpdate& each : updates)
      maps_.accept(each, {.bytes = 10}, nullptr,
                   [&](const icd::Checked<void>& said) { taken += said ? 1 : 0; });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return taken == updates.size(); }));
    maps_.on_endpoint_changed(icd::BearerToken::parse("a-token"));
  }
  icd::MapUpdate cloud_of(int points) {
    std::uniform_real_distribution<float> place(-100, 100);
    std::vector<float> xs;
    for (int i = 0; i < 3 * points; ++i) xs.push_back(place(random_));
    icd::MapUpdate map = cloud_along_x("r1", std::vector<float>(static_cast<std::size_t>(points)));
    std::vector<std::uint8_t> bytes(xs.size() * sizeof(float));
    std::memcpy(bytes.data(), xs.data(), bytes.size());
    map.data.bytes = icd::ChunkedBytes(bytes);
    return map;
  }
  /// A grid that does not compress below the limit.
  icd::MapUpdate noise(std::uint32_t width, std::uint32_t height) {
    std::vector<std::uint8_t> cells(std::size_t{width} * height);
    for (std::uint8_t& each : cells) each = static_cast<std::uint8_t>(random_() % 101);
    icd::MapUpdate map = grid_of("r1", 1);
    auto& grid = std::get<icd::OccupancyGrid>(map.msg);
    grid.width = width;
    grid.height = height;
    map.data = {icd::ChunkedBytes(cells), icd::Compression::None, cells.size()};
    return map;
  }
  /// It cannot be split.
  icd::MapUpdate one_row_of_noise() { return noise(640'000, 1); }
  std::vector<icd::MapUpdate> clouds(int count) {
    std::vector<icd::MapUpdate> all;
    for (int i = 0; i < count; ++i) all.push_back(cloud_of(kPoints));
    return all;
  }
  const facts::ActivityRow& row() const { return counts_.rows().at({TrafficKind::Cloud, "r1"}); }
  bool becomes(std::size_t waiting) {
    return loop::turn_until(loop_, [&] { return maps_.waiting({TrafficKind::Cloud, "r1"}) == waiting; });
  }

  std::optional<ProxyStub> proxy_;  // outlives the connections to it
  std::size_t delivered_ = 0;       // bytes of points
  Maps maps_{loop_,        servers_, workers_,
             writer_,      spool_,   settings_,
             std::nullopt, counts_,  rejected_,
             random_,      journal_, [this](const icd::MapUpdate& map) { delivered_ += map.data.raw_size; }};
};

TEST_F(TooLargeMap, IsSentInSmallerMessagesIfItWasJoined) {
  send(clouds(kClouds));
  ASSERT_TRUE(becomes(0));
  EXPECT_EQ(delivered_, std::size_t{12} * kPoints * kClouds) << "each point once";
  EXPECT_GE(proxy_->too_large, 1);
  EXPECT_LE(proxy_->too_large, 2) << "its halves are no larger than what has passed";
  EXPECT_THAT(rejected_.rows(), IsEmpty());
  EXPECT_EQ(maps_.channel().last().foreign(), 0);
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path())) << "the stored maps are deleted";
}

TEST_F(TooLargeMap, IsStoredUntilItsLastPartIsDelivered) {
  send(clouds(kClouds));
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return delivered_ > 0; }));
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_GE(spool::Spool(folder_.path()).read().size() * 12 * kPoints + delivered_,
            std::size_t{12} * kPoints * kClouds);
}

TEST_F(TooLargeMap, IsSentInSmallerMessagesAfterThreeResetsWhileOthersAreDelivered) {
  send(clouds(kClouds), nullptr);
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return row().failed >= 2; }));
  EXPECT_EQ(delivered_, 0u);
  ASSERT_TRUE(loop::turn_until(loop_, [&] {
    counts_.count_forwarded({TrafficKind::State, "r2"}, 1, 100, 200, 0);
    maps_.on_link_up();  // no back-off
    return maps_.waiting({TrafficKind::Cloud, "r1"}) == 0;
  }));
  EXPECT_EQ(delivered_, std::size_t{12} * kPoints * kClouds);
  EXPECT_LE(proxy_->too_large, 5);
}

TEST_F(TooLargeMap, IsSentInSmallerMessagesAfterThreePagesWith400WhileOthersAreDelivered) {
  send({cloud_of(10 * kPoints)}, kPage, "400 Bad Request");
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return row().failed >= 2; }));
  EXPECT_THAT(row().last_sentence, Not(HasSubstr("smaller messages")));
  const auto others_pass_until = [&](const std::function<bool()>& is_done) {
    return loop::turn_until(loop_, [&] {
      counts_.count_forwarded({TrafficKind::State, "r2"}, 1, 100, 200, 0);
      maps_.on_link_up();  // no back-off
      return is_done();
    });
  };
  ASSERT_TRUE(
      others_pass_until([&] { return row().last_sentence.contains("it is sent in smaller messages"); }));
  EXPECT_EQ(row().failed, 4u) << "nothing else was delivered between the first two";
  ASSERT_TRUE(others_pass_until([&] { return maps_.waiting({TrafficKind::Cloud, "r1"}) == 0; }));
  EXPECT_EQ(proxy_->points().size(), std::size_t{10} * kPoints);
  EXPECT_THAT(rejected_.rows(), IsEmpty());
}

TEST_F(TooLargeMap, IsRejectedAfterA400WithJson) {
  send({cloud_of(10 * kPoints)}, "\"no\"", "400 Bad Request");
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return !rejected_.rows().empty(); }));
  EXPECT_EQ(proxy_->too_large, 1);
}

TEST_F(TooLargeMap, IsSentInPiecesIfItIsASingleCloud) {
  std::vector<icd::MapUpdate> single{cloud_of(10 * kPoints), cloud_of(10 * kPoints)};
  single.back().data.bytes = codec::gzip(single.back().data.bytes, codec::GzipStrategy::Default);
  single.back().data.compression = icd::Compression::Gzip;
  std::multiset<float> xs;
  for (const icd::MapUpdate& each : single) {
    const auto some = xs_of(each.data);
    xs.insert(some.begin(), some.end());
  }
  send(single);
  ASSERT_TRUE(becomes(0));
  EXPECT_EQ(proxy_->points(), xs) << "each point once";
  EXPECT_LE(proxy_->too_large, 3) << "the second cloud is sent within the limit at once";
  EXPECT_THAT(rejected_.rows(), IsEmpty());
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(TooLargeMap, LeavesOutPiecesWithoutAValidPoint) {
  icd::MapUpdate cloud = cloud_of(20 * kPoints);
  auto bytes = codec::bytes_of(cloud.data);
  const float invalid = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t at = bytes.size() / 2; at < bytes.size(); at += 12)
    std::memcpy(bytes.data() + at, &invalid, sizeof invalid);
  cloud.data.bytes = icd::ChunkedBytes(bytes);
  send({cloud});
  ASSERT_TRUE(becomes(0));
  EXPECT_EQ(proxy_->points().size(), std::size_t{10} * kPoints);
  EXPECT_FALSE(proxy_->has_empty_cloud);
  EXPECT_THAT(rejected_.rows(), IsEmpty());
}

TEST_F(TooLargeMap, IsStoredUntilItsLastPieceIsDelivered) {
  send({cloud_of(10 * kPoints)});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return row().forwarded == 2; }));
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  ASSERT_EQ(spool::Spool(folder_.path()).read().size(), 1u);
  ASSERT_TRUE(becomes(0));
}

TEST_F(TooLargeMap, BeginsAgainIfAnotherRunBeginsBetweenItsPieces) {
  const icd::MapUpdate cloud = cloud_of(10 * kPoints);
  send({cloud});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return row().forwarded == 3; }));
  proxy_->forget();
  maps_.change_run(dispatch::NextMap::Empty);
  ASSERT_TRUE(becomes(0));
  const auto points = proxy_->points();
  for (const float x : xs_of(cloud.data)) ASSERT_TRUE(points.contains(x));
  EXPECT_THAT(rejected_.rows(), IsEmpty());
}

TEST_F(TooLargeMap, BeginsAgainAtAnotherAddress) {
  const icd::MapUpdate cloud = cloud_of(10 * kPoints);
  send({cloud});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return row().forwarded == 3; }));
  ProxyStub other(kPage);
  settings_.command_post.mapping = other.address();
  maps_.on_endpoint_changed(icd::BearerToken::parse("a-token"));
  ASSERT_TRUE(becomes(0));
  const auto points = other.points();
  for (const float x : xs_of(cloud.data)) ASSERT_TRUE(points.contains(x));
  settings_.command_post.mapping = proxy_->address();  // outlives the connections to it
  maps_.on_endpoint_changed(icd::BearerToken::parse("a-token"));
}

TEST_F(TooLargeMap, IsSentInRowsIfItIsASingleGrid) {
  icd::MapUpdate map = noise(800, 800);
  auto& grid = std::get<icd::OccupancyGrid>(map.msg);
  grid.origin = {.position = {10, -3, 1}, .orientation = {0, 0, std::sqrt(0.5), std::sqrt(0.5)}};
  send({map});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_.waiting({TrafficKind::Grid, "r1"}) == 0; }));
  std::vector<std::uint8_t> cells;
  for (const ProxyStub::Rows& rows : proxy_->grids()) {
    EXPECT_EQ(rows.grid.width, grid.width);
    EXPECT_EQ(rows.grid.resolution, grid.resolution);
    EXPECT_EQ(rows.grid.origin.orientation, grid.origin.orientation);
    const double along_y = static_cast<double>(cells.size() / grid.width) * grid.resolution;
    EXPECT_NEAR(rows.grid.origin.position.x, 10 - along_y, 1e-9);
    EXPECT_NEAR(rows.grid.origin.position.y, -3, 1e-9);
    EXPECT_NEAR(rows.grid.origin.position.z, 1, 1e-9);
    cells.insert(cells.end(), rows.cells.begin(), rows.cells.end());
  }
  EXPECT_EQ(cells, codec::bytes_of(map.data)) << "each row once";
  EXPECT_LE(proxy_->too_large, 1);
  EXPECT_EQ(delivered_, map.data.raw_size);
  EXPECT_THAT(rejected_.rows(), IsEmpty());
  ASSERT_TRUE(loop::turn_until_idle(loop_, writer_));
  EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(TooLargeMap, LosesNoRowsIfGridsAreReplacedFasterThanTheirRowsAreSent) {
  constexpr std::uint32_t kSide = 1000;
  send({noise(kSide, kSide)});
  std::vector<std::uint8_t> newest;
  for (std::size_t i = 1; i <= 8; ++i) {
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return proxy_->grids().size() >= i; }));
    icd::MapUpdate newer = noise(kSide, kSide);
    newest = codec::bytes_of(newer.data);
    bool is_queued = false;
    maps_.accept(std::move(newer), {.bytes = 10}, nullptr,
                 [&](const icd::Checked<void>& said) { is_queued = said.has_value(); });
    ASSERT_TRUE(loop::turn_until(loop_, [&] { return is_queued; }));
  }
  const auto row_of = [](const ProxyStub::Rows& rows) {
    return static_cast<std::size_t>(std::lround(rows.grid.origin.position.y / rows.grid.resolution));
  };
  const std::size_t when_replaced = proxy_->grids().size();
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_.waiting({TrafficKind::Grid, "r1"}) == 0; }));
  std::set<std::size_t> sent;
  std::vector<std::uint8_t> there(newest.size());
  const auto grids = proxy_->grids();
  for (std::size_t i = 0; i < grids.size(); ++i) {
    const std::size_t first = row_of(grids[i]);
    std::ranges::copy(grids[i].cells, there.begin() + static_cast<std::ptrdiff_t>(first * kSide));
    for (std::size_t row = first; i < when_replaced && row < first + grids[i].grid.height; ++row)
      sent.insert(row);
  }
  EXPECT_EQ(sent.size(), kSide) << "while no grid was sent as a whole";
  EXPECT_TRUE(there == newest);
}

TEST_F(TooLargeMap, IsNotTheFaultOfTheAddress) {
  send({one_row_of_noise()});
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_.channel().last().status() == 413; }));
  EXPECT_FALSE(maps_.channel().last().is_foreign());
  EXPECT_THAT(maps_.channel().trouble(), HasSubstr("too large ("));
  EXPECT_THAT(counts_.rows().at({TrafficKind::Grid, "r1"}).last_sentence,
              HasSubstr(" kB): the Command Post answered 413"));
  EXPECT_EQ(maps_.waiting({TrafficKind::Grid, "r1"}), 1) << "nobody else's map has passed";
}

TEST_F(TooLargeMap, IsRejectedWithItsSizeByTheCommandPostItself) {
  send({one_row_of_noise()}, "\"no room\"");
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return !rejected_.rows().empty(); }));
  ASSERT_EQ(rejected_.rows().size(), 1u);
  EXPECT_THAT(rejected_.rows().front().why, HasSubstr("too large ("));
  EXPECT_THAT(rejected_.rows().front().why, HasSubstr("no room"));
}

}  // namespace
}  // namespace adit::forward
