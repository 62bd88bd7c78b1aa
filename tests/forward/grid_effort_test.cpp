// A stored grid is sent unchanged unless that takes long.
#include <gtest/gtest.h>

#include "codec/gzip.hpp"
#include "forward/manual_endpoint.hpp"

namespace adit::forward {
namespace {

/// Stored with run-length compression, which misses that its rows are equal.
icd::MapUpdate kept_grid(const char* robot, std::uint32_t side) {
  icd::MapUpdate map = grid_of(robot, side);
  std::vector<std::uint8_t> cells(std::size_t{side} * side);
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i] = static_cast<std::uint8_t>(i % side / 64 * 37 % 101);
  map.data.bytes = codec::gzip(icd::ChunkedBytes(cells), codec::GzipStrategy::Runs);
  map.data.compression = icd::Compression::Gzip;
  return map;
}

class StoredGrid : public MapsToManualEndpoint {
 protected:
  StoredGrid() {
    settings_.command_post.rates.map_hz = 1;
    maps_->on_settings_changed();
  }
  std::uint64_t sent(const char* robot) const {
    return counts_.rows().at({TrafficKind::Grid, robot}).bytes_sent;
  }
  bool are_delivered() {
    return loop::turn_until(loop_, [&] {
      return maps_->waiting({TrafficKind::Grid, "first"}) + maps_->waiting({TrafficKind::Grid, "second"}) ==
             0;
    });
  }
};

TEST_F(StoredGrid, IsSentUnchangedAfterWaiting) {
  const icd::MapUpdate first = kept_grid("first", 1100), second = kept_grid("second", 1100);
  accept(first);
  ASSERT_TRUE(receives({"first"}));
  accept(second);
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return maps_->queued_bytes() == 0 && !maps_->packing(); }));
  for (int i = 0; i < 2; ++i) post_.answer("200 OK");
  ASSERT_TRUE(are_delivered());
  EXPECT_GT(sent("first"), first.data.bytes.size());
  EXPECT_GT(sent("second"), second.data.bytes.size());
}

TEST_F(StoredGrid, IsCompressedForASlowLink) {
  settings_.command_post.budget_mbit = 1;
  maps_->on_settings_changed();
  const icd::MapUpdate large = kept_grid("second", 1100);
  accept(large);
  post_.answer("200 OK");
  ASSERT_TRUE(are_delivered());
  EXPECT_LT(sent("second"), large.data.bytes.size() / 2);
}

}  // namespace
}  // namespace adit::forward
