#include "rehearsal/robots/dated.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace adit::robots {
namespace {

constexpr std::array<std::uint8_t, 5> kDateFollows = {13, 87, 42, 61, 99};  // no value of the cave's cells
constexpr std::size_t kDigits = 5;
constexpr std::uint64_t kBase = 101;
constexpr int kUint32 = 6;  // ICD 6.3.2
static_assert(std::endian::native == std::endian::little, "clouds are sent little endian");

std::uint64_t milliseconds_of(Moment moment) {
  return static_cast<std::uint64_t>(moment.time_since_epoch().count());
}

}  // namespace

void date(Grid& grid, Moment posted) {
  if (grid.width < kDateFollows.size() + kDigits) return;
  auto cell = std::ranges::copy(kDateFollows, grid.cells.begin()).out + kDigits;
  std::uint64_t rest = milliseconds_of(posted);
  for (std::size_t i = 0; i < kDigits; ++i, rest /= kBase) *--cell = static_cast<std::uint8_t>(rest % kBase);
}

void date(Cloud& cloud, Moment posted) {
  const std::uint32_t before = cloud.point_step;
  const auto date = static_cast<std::uint32_t>(milliseconds_of(posted));
  cloud.fields.push_back({"posted_ms", before, kUint32, 1});
  cloud.point_step += sizeof date;
  std::vector<std::uint8_t> dated(cloud.data.size() / before * cloud.point_step);
  for (std::size_t from = 0, to = 0; to < dated.size(); from += before, to += cloud.point_step) {
    std::memcpy(&dated[to], &cloud.data[from], before);
    std::memcpy(&dated[to + before], &date, sizeof date);
  }
  cloud.data = std::move(dated);
}

}  // namespace adit::robots
