#include "pack/same_as_before.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace adit::pack {
namespace {

/// One byte after the other.
std::size_t first_other(const std::vector<std::uint8_t>& bytes, std::size_t first, std::size_t distance,
                        std::size_t place, std::size_t end) {
  while (place < end && place >= first + distance && bytes[place] == bytes[place - distance]) ++place;
  return place;
}

TEST(SameAsBefore, FindsTheFirstOtherByteWhereverItIsAsked) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 400; ++round) {
    const std::size_t end = 1 + random() % 3000, first = random() % end;
    const std::size_t distance = 1 + random() % (random() % 2 == 0 ? 4 : 400);
    std::vector<std::uint8_t> bytes(end + 64);
    const std::size_t rare = 1 + random() % 300;
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      bytes[i] =
          i >= distance && random() % rare != 0 ? bytes[i - distance] : static_cast<std::uint8_t>(random());
    }
    SameAsBefore same(bytes.data(), first, distance);
    for (std::size_t place = first; place < end; place += random() % 3 == 0 ? random() % 200 : 1) {
      const std::size_t expected = first_other(bytes, first, distance, place, end);
      ASSERT_EQ(std::min(same.until(place, end), end), expected)
          << place << " of " << end << ", " << distance;
    }
  }
}

TEST(SameAsBefore, TellsEachOfTheByteValuesFromAnyOther) {
  for (unsigned value = 0; value < 256; ++value) {
    for (unsigned other = 0; other < 256; ++other) {
      std::vector<std::uint8_t> bytes(256, static_cast<std::uint8_t>(value));
      bytes[100] = static_cast<std::uint8_t>(other);
      SameAsBefore same(bytes.data(), 0, 1);
      ASSERT_EQ(std::min<std::size_t>(same.until(1, 192), 192), value == other ? 192 : 100);
    }
  }
}

}  // namespace
}  // namespace adit::pack
