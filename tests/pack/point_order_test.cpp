#include "pack/point_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>

#include "pack/layouts.hpp"

namespace adit::pack {
namespace {

using Places = std::vector<Coordinates>;

std::vector<std::uint32_t> in(Layers layers, const Layout& layout, const Places& places) {
  Bytes bytes;
  Box box;
  for (const auto& [x, y, z] : places) {
    const Bytes point = point_of(layout, x, y, z, 0);
    bytes.insert(bytes.end(), point.begin(), point.end());
    box.add({x, y, z});
  }
  return numbers_in(layers, cloud_of(layout), box, bytes);
}

/// Whole numbers, so that each is a step of its own.
Places some(std::mt19937_64& random, int count, int most) {
  std::uniform_int_distribution any{0, most};
  Places places{{0, 0, 0}};
  const double last = most;
  places.push_back({last, last, last});
  for (int i = 0; i < count; ++i) {
    places.push_back({static_cast<double>(any(random)), static_cast<double>(any(random)),
                      static_cast<double>(any(random))});
  }
  return places;
}

/// In layers along `first`, and then by the others.
void expect_sorted(Layers layers, std::size_t first, std::size_t second, std::size_t third) {
  std::mt19937_64 random{1};
  for (const Layout& layout : kLayouts) {
    if (layout.step > 1000) continue;
    for (const int most : {3, 15, 2047}) {
      const Places places = some(random, 600, most);
      std::vector<std::uint32_t> expected(places.size());
      std::iota(expected.begin(), expected.end(), 0U);
      std::ranges::stable_sort(expected, {}, [&](std::uint32_t number) {
        const Coordinates& at = places[number];
        return std::tuple(at[first], at[second], at[third]);
      });
      EXPECT_EQ(in(layers, layout, places), expected) << layout.what;
    }
  }
}

TEST(PointOrder, IsByOneCoordinateThenTheOthersAndStable) {
  expect_sorted(Layers::AlongX, 0, 2, 1);
  expect_sorted(Layers::AlongY, 1, 0, 2);
  expect_sorted(Layers::AlongZ, 2, 1, 0);
}

TEST(PointOrder, HasEachPointOnceWhateverTheCoordinates) {
  const double most = std::numeric_limits<double>::max(), least = std::numeric_limits<double>::denorm_min();
  const Places sets[] = {{},
                         {{1, 2, 3}},
                         Places(100, {5, 5, 5}),
                         {{most, 0, 0}, {-most, most, -most}, {0, 0, most}},
                         {{least, 0, -least}, {0, least, 0}, {-0.0, 0, 0}},
                         {{1, 1, 1}, {1, 1, 2}, {most, 1, 1}}};
  for (const Places& places : sets) {
    for (const Layers layers : {Layers::AlongX, Layers::AlongY, Layers::AlongZ}) {
      auto numbers = in(layers, kLayouts[2], places);
      std::ranges::sort(numbers);
      std::vector<std::uint32_t> all(places.size());
      std::iota(all.begin(), all.end(), 0U);
      EXPECT_EQ(numbers, all);
    }
  }
}

}  // namespace
}  // namespace adit::pack
