#include "pack/grid_gzipper.hpp"

#include <gtest/gtest.h>

#include "pack/grids.hpp"
#include "pack/only_member.hpp"

namespace adit::pack {
namespace {

using Bytes = std::vector<std::uint8_t>;

icd::ChunkedBytes packed(const Bytes& cells, std::size_t width) {
  GridGzipper gzipper(width);
  gzipper.feed(cells);
  return gzipper.finish();
}

void expect_given_back(const Bytes& cells, std::size_t width) {
  const icd::ChunkedBytes member = packed(cells, width);
  ASSERT_EQ(only_member(member, cells.size()), cells) << width << " wide, " << cells.size();
  EXPECT_LE(member.size(), cells.size() + cells.size() / 64 + 300);
}

/// What repeats itself at some distance with others in between, of so many values.
Bytes repeating(std::size_t size, std::size_t distance, std::size_t rare, unsigned values,
                std::mt19937_64& random) {
  Bytes bytes(size);
  for (std::size_t i = 0; i < size; ++i) {
    bytes[i] = i >= distance && random() % rare != 0 ? bytes[i - distance]
                                                     : static_cast<std::uint8_t>(random() % values);
  }
  return bytes;
}

TEST(GridGzipper, GivesBackWhatItWasFed) {
  for (const Grid& grid : {cave(300, 200, 1), graded(cave(200, 150, 2)), speckled(cave(200, 300, 3)),
                           measured(cave(150, 150, 4)), noise(100, 90, 101), noise(120, 80, 2),
                           noise(90, 100, 256), Grid("all unknown", 700, 400), Grid("one row", 90'000, 1, 0),
                           Grid("one column", 1, 5000), Grid("one cell", 1, 1)}) {
    SCOPED_TRACE(grid.what);
    expect_given_back(grid.cells, grid.width);
  }
}

TEST(GridGzipper, GivesBackWhateverRepeatsItselfWhereverItLooks) {
  std::mt19937_64 random(1);
  const std::size_t widths[] = {1,    2,    3,    4,    63,     64,     65,     257,    258,   259,
                                1000, 8191, 8192, 8193, 32'766, 32'767, 32'768, 32'769, 40'000};
  for (const std::size_t width : widths) {
    for (const std::size_t off : {width, width + 1, width - 1}) {
      const std::size_t distance = std::max<std::size_t>(off, 1);
      expect_given_back(repeating(90'000, distance, 1 + random() % 500, 1 + random() % 256, random), width);
    }
  }
}

TEST(GridGzipper, GivesBackRunsOfEveryLength) {
  Bytes cells;
  for (std::size_t length = 1; length <= 600; ++length)
    cells.insert(cells.end(), length, static_cast<std::uint8_t>(length % 2 == 0 ? 0 : 100));
  for (const std::size_t width : {1, 100, 600, 50'000}) expect_given_back(cells, width);
}

TEST(GridGzipper, GivesBackGridsOfEverySmallSize) {
  std::mt19937_64 random(2);
  for (std::size_t width = 1; width < 20; ++width) {
    for (std::size_t height = 1; height < 20; ++height) {
      expect_given_back(repeating(width * height, width, 3, 3, random), width);
    }
  }
}

TEST(GridGzipper, GivesBackWhatIsAsLongAsItsPieces) {
  std::mt19937_64 random(3);
  for (const std::size_t piece : {8192, 131'072, 131'072 + 32'768}) {
    for (const int off : {-259, -258, -257, -1, 0, 1, 257, 258, 259}) {
      expect_given_back(repeating(piece + static_cast<std::size_t>(off), 500, 40, 3, random), 500);
    }
  }
}

TEST(GridGzipper, OfNothingIsTheMemberOfNothing) {
  expect_given_back({}, 1);
}

TEST(GridGzipper, MakesTheSameOfPiecesOfAnySize) {
  const Grid grid = speckled(cave(700, 500, 5));
  const icd::ChunkedBytes whole = packed(grid.cells, grid.width);
  std::mt19937_64 random(4);
  for (const std::size_t most : {1, 100, 70'000}) {
    GridGzipper gzipper(grid.width);
    for (std::size_t at = 0, size = 0; at < grid.cells.size(); at += size) {
      size = std::min(grid.cells.size() - at, 1 + random() % most);
      gzipper.feed(std::span(grid.cells).subspan(at, size));
    }
    EXPECT_EQ(gzipper.finish(), whole) << most;
  }
}

TEST(GridGzipper, MakesRowsThatRepeatThemselvesNextToNothing) {
  std::mt19937_64 random(5);
  for (const std::size_t distance : {999, 1000, 1001}) {
    const Bytes cells = repeating(200'000, distance, 1'000'000'000, 101, random);
    EXPECT_LT(packed(cells, 1000).size(), 3500U) << distance;  // of which the first row takes a quarter
  }
}

TEST(GridGzipper, MakesACaveSmallerThanZlibAtItsBest) {
  const Grid grid = cave(600, 600, 6);
  Bytes out(grid.cells.size());
  z_stream stream{};
  deflateInit2(&stream, 9, Z_DEFLATED, MAX_WBITS + 16, 8, Z_DEFAULT_STRATEGY);
  stream.next_in = const_cast<Bytef*>(grid.cells.data());
  stream.avail_in = static_cast<uInt>(grid.cells.size());
  stream.next_out = out.data();
  stream.avail_out = static_cast<uInt>(out.size());
  ASSERT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
  EXPECT_LE(packed(grid.cells, grid.width).size(), stream.total_out);
  deflateEnd(&stream);
}

}  // namespace
}  // namespace adit::pack
