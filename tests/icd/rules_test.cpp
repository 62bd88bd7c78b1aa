// The ICD's rules over several fields of a map, one row for each violation.
#include "icd/rules.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "icd/sentence.hpp"

namespace adit::icd {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

OccupancyGrid good_grid() {
  return {.header = {}, .resolution = 0.2, .width = 80, .height = 60, .origin = {}};
}

FieldSchema field(std::string name, std::uint32_t offset, Datatype datatype = Datatype::Float32,
                  std::uint32_t count = 1) {
  return {.name = std::move(name), .offset = offset, .datatype = datatype, .count = count};
}

PointCloud2 good_cloud() {
  return {.header = {},
          .origin = {},
          .fields = {field("x", 0), field("y", 4), field("z", 8), field("rgba", 12, Datatype::Uint32)},
          .is_bigendian = false,
          .point_step = 16};
}

std::string sentence_of(const Checked<void>& checked) {
  if (checked) return "accepted";
  if (checked.error().status != Status::UnprocessableEntity)
    return sentence(static_cast<int>(checked.error().status), ": ", checked.error().sentence);
  return checked.error().sentence;
}

struct GridRow {
  const char* section;
  std::function<void(OccupancyGrid&)> change;
  const char* sentence;
};

TEST(GridRules, TellExpectedAndActualValues) {
  const GridRow rows[] = {
      {"6.3.1", [](auto&) {}, "accepted"},
      {"6.3.1", [](auto& g) { g.resolution = 8e-46; }, "accepted"},  // becomes the smallest float32
      {"6.3.1", [](auto& g) { g.resolution = 7e-46; },
       "msg.info.resolution: expected a finite float32 above 0, got 7e-46"},
      {"6.3.1", [](auto& g) { g.resolution = 0; },
       "msg.info.resolution: expected a finite float32 above 0, got 0"},
      {"6.3.1", [](auto& g) { g.resolution = -0.1; },
       "msg.info.resolution: expected a finite float32 above 0, got -0.1"},
      {"6.3.1", [](auto& g) { g.resolution = kNan; },
       "msg.info.resolution: expected a finite float32 above 0, got nan"},
      {"6.3.1", [](auto& g) { g.resolution = kInfinity; },
       "msg.info.resolution: expected a finite float32 above 0, got inf"},
      {"6.3.1", [](auto& g) { g.width = 0; },
       "msg.info.width: expected a whole number from 1 to 2147483647, got 0"},
      {"6.3.1", [](auto& g) { g.width = 0x80000000; },
       "msg.info.width: expected a whole number from 1 to 2147483647, got 2147483648"},
      {"6.3.1", [](auto& g) { g.height = 0; },
       "msg.info.height: expected a whole number from 1 to 2147483647, got 0"},
      {"6.3.1",
       [](auto& g) {
         g.width = 100;
         g.height = 100;
       },
       "accepted"},
      {"6.3.1",
       [](auto& g) {
         g.width = 101;
         g.height = 100;
       },
       "413: msg.info.width: expected at most 10000 cells (the setting rules.map_bytes), got 101 x 100 = "
       "10100"},
      {"6.3.1 in 64 bits",
       [](auto& g) {
         g.width = 0x40000000;
         g.height = 8;
       },
       "413: msg.info.width: expected at most 10000 cells, got 1073741824 x 8 = 8589934592"},
  };
  Rules rules;
  rules.map_bytes = 10'000;
  for (const auto& row : rows) {
    OccupancyGrid grid = good_grid();
    row.change(grid);
    EXPECT_EQ(sentence_of(check(grid, rules)), row.sentence) << "ICD " << row.section;
  }
}

TEST(GridRules, NameTheSettingThatWouldAcceptALargerGrid) {
  Rules rules;
  rules.map_bytes = 10'000;
  OccupancyGrid grid = good_grid();
  grid.width = 101, grid.height = 100;
  EXPECT_EQ(check(grid, rules).error().setting, "rules.map_bytes");
  grid.width = 0x40000000, grid.height = 8;
  EXPECT_EQ(check(grid, rules).error().setting, "") << "larger than the setting can be";
  grid.width = 0;
  EXPECT_EQ(check(grid, rules).error().setting, "");
}

TEST(GridSize, IsWidthTimesHeight) {
  EXPECT_EQ(sentence_of(check_size(good_grid(), 4800)), "accepted");
  EXPECT_EQ(sentence_of(check_size(good_grid(), 4799)),
            "msg.info.width: expected 80 x 60 = 4800 bytes of data, got 4799");
  EXPECT_EQ(sentence_of(check_size(good_grid(), 4801)),
            "msg.info.width: expected 80 x 60 = 4800 bytes of data, got 4801");
}

TEST(Cells, AreZeroToAHundredOrUnknown) {  // ICD 6.3.1
  for (int value = 0; value < 256; ++value) {
    std::vector<std::uint8_t> cells(100, 50);
    cells[73] = static_cast<std::uint8_t>(value);
    const bool good = value <= 100 || value == 255;
    EXPECT_EQ(sentence_of(check_cells(cells, 1000)),
              good ? "accepted" : sentence("msg.data[1073]: expected 0 to 100 or 255, got ", value));
  }
  EXPECT_EQ(sentence_of(check_cells({}, 0)), "accepted");
}

struct CloudRow {
  const char* section;
  std::function<void(PointCloud2&)> change;
  const char* sentence;
};

TEST(CloudRules, TellExpectedAndActualValues) {
  const CloudRow rows[] = {
      {"6.3.2", [](auto&) {}, "accepted"},
      {"6.3.2 and kills a server", [](auto& c) { c.point_step = 0; },
       "msg.point_step: expected a whole number from 1 to 65536, got 0"},
      {"6.3.2", [](auto& c) { c.point_step = 65536; }, "accepted"},
      {"6.3.2", [](auto& c) { c.point_step = 65537; },
       "msg.point_step: expected a whole number from 1 to 65536, got 65537"},
      {"6.3.2", [](auto& c) { c.fields.clear(); },
       "msg.fields: expected at least x, y and z, got an empty list"},
      {"6.3.2", [](auto& c) { c.fields.resize(257, field("intensity", 0)); },
       "msg.fields: expected at most 256 fields, got 257"},
      {"6.3.2", [](auto& c) { c.fields.resize(256, field("intensity", 0)); }, "accepted"},
      {"6.3.2", [](auto& c) { c.fields[3].count = 0; }, "msg.fields[3].count: expected at least 1, got 0"},
      {"6.3.2 and kills a server", [](auto& c) { c.point_step = 15; },
       "msg.fields[3].offset: expected the field to end within point_step 15, got 12 + 4 x 1 = 16"},
      {"6.3.2 and kills a server", [](auto& c) { c.fields[3].offset = 13; },
       "msg.fields[3].offset: expected the field to end within point_step 16, got 13 + 4 x 1 = 17"},
      {"6.3.2 in 64 bits", [](auto& c) { c.fields[3] = field("n", 8, Datatype::Float64, 0x20000000); },
       "msg.fields[3].offset: expected the field to end within point_step 16, got 8 + 8 x 536870912 = "
       "4294967304"},
      {"6.3.2 in 64 bits", [](auto& c) { c.fields[3].offset = 0xffffffff; },
       "msg.fields[3].offset: expected the field to end within point_step 16, got 4294967295 + 4 x 1 = "
       "4294967299"},
      {"6.3.2", [](auto& c) { c.fields[1] = field("Y", 4); }, "msg.fields: missing field \"y\""},
      {"6.3.2", [](auto& c) { c.fields.erase(c.fields.begin()); }, "msg.fields: missing field \"x\""},
      {"6.3.2", [](auto& c) { c.fields[3] = field("z", 12); }, "msg.fields: expected one field \"z\", got 2"},
      {"6.3.2", [](auto& c) { c.fields.insert(c.fields.end(), 2, field("rgba", 12)); }, "accepted"},
      {"6.3.2", [](auto& c) { c.fields[0].datatype = Datatype::Int32; },
       "msg.fields[0].datatype: expected 7 or 8 for \"x\", got 5"},
      {"6.3.2", [](auto& c) { c.fields[2].datatype = Datatype::Uint8; },
       "msg.fields[2].datatype: expected 7 or 8 for \"z\", got 2"},
      {"6.3.2", [](auto& c) { c.fields[2].datatype = Datatype::Float64; },
       "msg.fields[2].datatype: expected 7 as for \"x\", got 8"},
      {"6.3.2", [](auto& c) { c.fields[1].count = 2; }, "msg.fields[1].count: expected 1 for \"y\", got 2"},
      {"6.3.2",
       [](auto& c) {
         c.point_step = 24;
         c.fields = {field("z", 0, Datatype::Float64), field("y", 8, Datatype::Float64),
                     field("x", 16, Datatype::Float64)};
       },
       "accepted"},
  };
  for (const auto& row : rows) {
    PointCloud2 cloud = good_cloud();
    row.change(cloud);
    EXPECT_EQ(sentence_of(check(cloud, Rules{})), row.sentence) << "ICD " << row.section;
  }
}

TEST(CloudSize, IsAWholeNumberOfPoints) {  // ICD 6.3.2
  EXPECT_EQ(sentence_of(check_size(good_cloud(), 0)), "accepted");
  EXPECT_EQ(sentence_of(check_size(good_cloud(), 160)), "accepted");
  EXPECT_EQ(sentence_of(check_size(good_cloud(), 161)),
            "msg.data: expected a multiple of point_step 16, got 161 bytes");
}

TEST(FrameId, IsDarpaUnlessTheSettingsRewriteIt) {  // ICD 6.1
  EXPECT_EQ(sentence_of(check_frame_id("darpa", "header.frame_id", {})), "accepted");
  for (const std::string frame : {"map", "Darpa", "darpa ", "/darpa"}) {
    EXPECT_EQ(sentence_of(check_frame_id(frame, "header.frame_id", {})),
              sentence("header.frame_id: expected \"darpa\", got \"", frame,
                       "\" (the setting rules.rewrite_frame_id accepts any frame)"));
    EXPECT_EQ(check_frame_id(frame, "header.frame_id", {}).error().setting, "rules.rewrite_frame_id");
    Rules rewriting;
    rewriting.rewrite_frame_id = true;
    EXPECT_EQ(sentence_of(check_frame_id(frame, "header.frame_id", rewriting)), "accepted");
  }
}

}  // namespace
}  // namespace adit::icd
