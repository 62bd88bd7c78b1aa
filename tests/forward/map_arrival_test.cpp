#include <gtest/gtest.h>

#include <future>
#include <optional>

#include "forward/map_store.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"
#include "loop/turn_until.hpp"
#include "spool/messages.hpp"
#include "spool/no_file_above.hpp"

namespace adit::forward {
namespace {

using spool::cloud;
using spool::NoFileAbove;

constexpr std::uint64_t kNoSuchRoom = std::uint64_t{1} << 62;

class MapArrivalTest : public testing::Test {
 protected:
  std::shared_ptr<SpooledMapArrival> arrival() {
    return std::make_shared<SpooledMapArrival>(
        alive_, spool_, [this] { return spare_; },
        [this](icd::MapUpdate update, const intake::Sender&, std::shared_ptr<spool::MapFile> file,
               const auto&) { taken_ = spool_.keep(1, std::move(update), 0, std::move(file)); });
  }
  /// Returns the bytes that were not stored.
  icd::ChunkedBytes store(SpooledMapArrival& arrival, icd::ChunkedBytes bytes) {
    std::optional<icd::ChunkedBytes> said;
    arrival.store(std::move(bytes), [&](icd::ChunkedBytes left) { said = std::move(left); });
    EXPECT_TRUE(loop::turn_until(loop_, [&] { return said.has_value(); }));
    return said.value();
  }
  /// Waits for the writer.
  void settle() { ASSERT_TRUE(loop::turn_until_idle(loop_, *writer_)); }
  std::vector<std::string> names() const { return host::names_in(folder_.path()).value(); }

  host::Folder folder_;
  loop::Loop loop_;
  spool::Spool spool_{folder_.path()};
  std::unique_ptr<loop::Writer> writer_ = std::make_unique<loop::Writer>(loop_);
  std::shared_ptr<loop::Writer> alive_{writer_.get(), [](loop::Writer*) {}};
  std::uint64_t spare_ = 0;
  icd::Checked<icd::MapUpdate> taken_;
};

/// Removes the first `count` bytes from the map's data.
icd::ChunkedBytes take_front(icd::MapUpdate& map, std::size_t count) {
  const std::vector<std::uint8_t> all = map.data.bytes.to_vector();
  const std::span<const std::uint8_t> bytes(all);
  map.data.bytes = icd::ChunkedBytes(bytes.subspan(count));
  return icd::ChunkedBytes(bytes.first(count));
}

TEST_F(MapArrivalTest, HasAFileWhenItIsAccepted) {
  const icd::MapUpdate whole = cloud(50'000);
  icd::MapUpdate map = whole;
  const auto arriving = arrival();
  EXPECT_TRUE(store(*arriving, take_front(map, 300'001)).empty());
  EXPECT_TRUE(store(*arriving, take_front(map, 100'000)).empty());
  ASSERT_EQ(names().size(), 1u);
  EXPECT_TRUE(names().front().ends_with(spool::PartFile::kEnding)) << "not a map yet";
  auto data = arriving->stored_bytes();
  ASSERT_TRUE(data);
  EXPECT_EQ(data->size(), 400'001u);
  data->append(map.data.bytes);
  map.data.bytes = std::move(*data);
  EXPECT_EQ(map, whole);
  const NoFileAbove small(700'000);  // too small for a second copy
  arriving->accept(std::move(map), {}, [](const icd::Checked<void>&) {});
  ASSERT_TRUE(taken_) << taken_.error().sentence;
  EXPECT_EQ(*taken_, whole);
  EXPECT_EQ(names(), std::vector<std::string>{"map-00000001.cbor"});
  const auto kept = spool_.read();
  ASSERT_EQ(kept.size(), 1u);
  EXPECT_EQ(kept[0].map, whole);
}

TEST_F(MapArrivalTest, StoresDataThatChangedAfterItsArrival) {
  icd::MapUpdate map = cloud(50'000);
  const auto arriving = arrival();
  EXPECT_TRUE(store(*arriving, take_front(map, 300'000)).empty());
  ASSERT_TRUE(arriving->stored_bytes());
  const icd::MapUpdate other = cloud(10'000);
  arriving->accept(other, {}, [](const icd::Checked<void>&) {});
  ASSERT_TRUE(taken_) << taken_.error().sentence;
  EXPECT_EQ(*taken_, other);
  EXPECT_EQ(names(), std::vector<std::string>{"map-00000001.cbor"});
}

TEST_F(MapArrivalTest, LeavesNoFileIfItIsRejected) {
  auto arriving = arrival();
  EXPECT_TRUE(store(*arriving, cloud(1000).data.bytes).empty());
  EXPECT_EQ(names().size(), 1u);
  arriving.reset();
  settle();
  EXPECT_TRUE(names().empty());
}

TEST_F(MapArrivalTest, LeavesNoFileIfItOutlivesTheGateway) {
  auto arriving = arrival();
  std::promise<void> let_go;
  writer_->submit([until = let_go.get_future().share()] { until.wait(); }, [] {});
  arriving->store(cloud(1000).data.bytes, [](const icd::ChunkedBytes&) {});
  alive_.reset();
  let_go.set_value();
  writer_.reset();
  EXPECT_EQ(names().size(), 1u) << "the writer finishes";
  arriving->store(cloud(1000).data.bytes, [](const icd::ChunkedBytes&) {});
  arriving.reset();
  EXPECT_TRUE(names().empty());
}

TEST_F(MapArrivalTest, LeavesReservedRoomFree) {
  icd::MapUpdate map = cloud(50'000);
  const auto arriving = arrival();
  EXPECT_TRUE(store(*arriving, take_front(map, 300'000)).empty());
  spare_ = kNoSuchRoom;
  const icd::ChunkedBytes more = take_front(map, 100'000);
  EXPECT_EQ(store(*arriving, more), more) << "nothing was stored";
  EXPECT_EQ(arriving->stored_bytes()->size(), 300'000u);
}

TEST_F(MapArrivalTest, HasNoFileIfNothingWasStored) {
  spare_ = kNoSuchRoom;
  const auto arriving = arrival();
  EXPECT_FALSE(store(*arriving, cloud(1000).data.bytes).empty());
  EXPECT_TRUE(names().empty());
  const auto data = arriving->stored_bytes();
  ASSERT_TRUE(data);
  EXPECT_TRUE(data->empty());
  arriving->accept(cloud(1000), {}, [](const icd::Checked<void>&) {});
  EXPECT_EQ(taken_, cloud(1000));
}

}  // namespace
}  // namespace adit::forward
