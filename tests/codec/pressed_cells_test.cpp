// If a grid's type comes before its data, the cells are compressed as they arrive. The result and the
// errors are the same as if the type comes last.
#include <gtest/gtest.h>

#include <random>

#include "codec/deflated.hpp"
#include "codec/documents.hpp"
#include "codec/gzip.hpp"
#include "codec/read.hpp"

namespace adit::codec::test {
namespace {

using nlohmann::ordered_json;
using Randomness = std::mt19937_64;
using Bytes = std::vector<std::uint8_t>;

enum class Says : std::uint8_t { First, Last };

struct Grid {
  unsigned width = 1, height = 1;
  Bytes data;
  std::string compression;  // "": the member is missing
};

std::string text_of(const Bytes& bytes) {
  return {bytes.begin(), bytes.end()};
}

ordered_json message(const Grid& grid, const ordered_json& data, Says says) {
  ordered_json info{{"resolution", 0.1}, {"width", grid.width}, {"height", grid.height}};
  info["origin"]["position"] = {{"x", 0}, {"y", 0}, {"z", 0}};
  info["origin"]["orientation"] = {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}};
  ordered_json whole;
  if (says == Says::First) whole["type"] = "OccupancyGrid";
  whole["name"] = "r1";
  whole["msg"] = {{"info", info}, {"data", data}};
  if (!grid.compression.empty()) whole["msg"]["compression"] = grid.compression;
  if (says == Says::Last) whole["type"] = "OccupancyGrid";
  return whole;
}

struct Body {
  BodyKind kind;
  std::string text;
};

/// The body in each of the four forms of data.
std::vector<Body> bodies(const Grid& grid, Says says) {
  const auto cbor = [&](const ordered_json& data) {
    const auto bytes = ordered_json::to_cbor(message(grid, data, says));
    return std::string(bytes.begin(), bytes.end());
  };
  return {{kJsonBody, message(grid, base64_of(grid.data), says).dump()},
          {kJsonBody, message(grid, ordered_json(grid.data), says).dump()},
          {kCborBody, cbor(ordered_json(grid.data))},
          {kCborBody, cbor(ordered_json::binary(grid.data))}};
}

std::string inflated(const icd::ChunkedBytes& member) {
  std::string all;
  const auto size = gunzip(member, std::size_t{1} << 24, "data", [&](std::span<const std::uint8_t> piece) {
    all.append(piece.begin(), piece.end());
    return icd::Checked<void>{};
  });
  EXPECT_TRUE(size) << size.error().sentence;
  return all;
}

/// A map's cells in runs. Rarely with an invalid cell.
Bytes random_cells(std::size_t count, Randomness& random) {
  static constexpr std::uint8_t kLikely[] = {255, 0, 100, 50, 31, 139};
  Bytes cells;
  while (cells.size() < count) {
    const std::uint8_t cell = kLikely[random() % (random() % 50 == 0 ? 6 : 5)];
    cells.insert(cells.end(), std::min(count - cells.size(), 1 + random() % 300), cell);
  }
  if (random() % 4 == 0 && count > 0)
    cells[random() % count] = static_cast<std::uint8_t>(101 + random() % 154);
  return cells;
}

Grid random_grid(Randomness& random) {
  Grid grid;
  grid.width = 1 + static_cast<unsigned>(random() % 90);
  grid.height = 1 + static_cast<unsigned>(random() % 90);
  const std::size_t cells = static_cast<std::size_t>(grid.width) * grid.height;
  grid.data = random_cells(random() % 5 == 0 ? cells + random() % 3 - 1 : cells, random);
  if (random() % 16 == 0) grid.data.resize(random() % 3);
  if (random() % 4 == 0) grid.compression = random() % 2 == 0 ? "none" : "gzip";
  if (random() % 6 == 0) {
    const std::string member = gzipped(text_of(grid.data));
    grid.data.assign(member.begin(), member.end());
    grid.compression = "gzip";
  }
  return grid;
}

TEST(PressedCells, AreOneGzipMember) {
  const Grid grid{.width = 4, .height = 2, .data = {255, 255, 0, 0, 100, 7, 7, 7}, .compression = {}};
  for (const Body& body : bodies(grid, Says::First)) {
    const auto document = decode_in_chunks(body.kind, Split::MapData, body.text, 3);
    ASSERT_TRUE(document) << document.error().sentence;
    ASSERT_TRUE(document->pressed);
    EXPECT_EQ(document->pressed->count, 8u);
    EXPECT_TRUE(document->pressed->checked);
    EXPECT_EQ(inflated(document->data), text_of(grid.data));
  }
}

TEST(PressedCells, NeedAnUncompressedGridWithItsTypeFirst) {
  Grid grid{.width = 4, .height = 2, .data = Bytes(8, 0), .compression = {}};
  std::vector<Body> others = bodies(grid, Says::Last);
  for (const std::string_view type : {"PointCloud2", "OccupancyGrids", "Occupancy", ""}) {
    ordered_json other = message(grid, "AAAA", Says::First);
    other["type"] = type;
    others.push_back({kJsonBody, other.dump()});
  }
  others.push_back(
      {kJsonBody, R"({"name":"OccupancyGrid","x":{"type":"OccupancyGrid"},"msg":{"data":"AAAA"}})"});
  const std::string member = gzipped(text_of(grid.data));
  grid.data.assign(member.begin(), member.end());
  for (const Body& body : bodies(grid, Says::First)) others.push_back(body);
  for (const Body& body : others) {
    const auto document = decode(body.kind, Split::MapData, body.text);
    ASSERT_TRUE(document) << body.text;
    EXPECT_FALSE(document->pressed) << body.text;
  }
}

TEST(PressedCells, GiveTheSameMapAndTheSameRejections) {
  Randomness random(21);
  int good = 0;
  constexpr int kRounds = 50;
  for (int round = 0; round < kRounds; ++round) {
    const Grid grid = random_grid(random);
    const auto firsts = bodies(grid, Says::First), lasts = bodies(grid, Says::Last);
    for (std::size_t form = 0; form < firsts.size(); ++form) {
      const auto read = [&](const Body& body) -> icd::Checked<icd::MapUpdate> {
        auto document = decode_in_chunks(body.kind, Split::MapData, body.text, 1 + random() % 4000);
        if (!document) return std::unexpected(document.error());
        return read_map_update(std::move(*document), {});
      };
      const auto pressed = read(firsts[form]), later = read(lasts[form]);
      ASSERT_EQ(pressed.has_value(), later.has_value()) << firsts[form].text;
      if (!pressed) {
        ASSERT_EQ(pressed.error(), later.error()) << firsts[form].text;
        continue;
      }
      ASSERT_TRUE(*pressed == *later) << firsts[form].text;
      if (grid.compression != "gzip") {
        ASSERT_EQ(inflated(pressed->data.bytes), text_of(grid.data));
      }
      ++good;
    }
  }
  EXPECT_GT(good, kRounds);  // both results were common
  EXPECT_LT(good, 3 * kRounds);
}

TEST(PressedCells, AreTheSameIfTakenInPieces) {
  Randomness random(22);
  Bytes cells(300'000);  // incompressible, so that the copied data is large
  for (auto& cell : cells) cell = static_cast<std::uint8_t>(random() % 101);
  const Grid grid{.width = 600, .height = 500, .data = cells, .compression = {}};
  const std::string body = message(grid, base64_of(cells), Says::First).dump();
  BodyDecoder decoder(kJsonBody, Split::MapData, {});
  icd::ChunkedBytes data;
  for (std::string_view left = body; !left.empty();
       left.remove_prefix(std::min<std::size_t>(left.size(), 50'000))) {
    const std::string_view some = left.substr(0, 50'000);
    ASSERT_TRUE(decoder.feed({reinterpret_cast<const std::uint8_t*>(some.data()), some.size()}));
    EXPECT_LE(decoder.held_bytes(), 100'000u);
    data.append(decoder.take_data());
  }
  EXPECT_GT(data.size(), 100'000u);
  const auto document = decoder.finish();
  ASSERT_TRUE(document);
  data.append(document->data);
  EXPECT_EQ(inflated(data), text_of(cells));
}

}  // namespace
}  // namespace adit::codec::test
