#include "rehearsal/command_post/dates.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

namespace adit::rehearsal {
namespace {

using Milliseconds = std::chrono::milliseconds;

constexpr std::string_view kDateFollows = "\x0d\x57\x2a\x3d\x63";  // cells of 13, 87, 42, 61, 99
constexpr std::size_t kDigits = 5;
constexpr std::int64_t kBase = 101, kModulus = kBase * kBase * kBase * kBase * kBase;
constexpr std::uint32_t kUint32 = 6;  // ICD 6.3.2

/// The moment nearest to `now` whose milliseconds since 1970 are `value` modulo `modulus`.
Moment nearest(std::int64_t value, std::int64_t modulus, Moment now) {
  std::int64_t before = (now.time_since_epoch().count() - value) % modulus;
  if (before > modulus / 2) before -= modulus;
  if (before < -modulus / 2) before += modulus;
  return now - Milliseconds(before);
}

std::optional<Dates> dates_of_grid(std::string_view cells, Moment now) {
  std::optional<Dates> dates;
  for (std::size_t at = cells.find(kDateFollows); at != std::string_view::npos;
       at = cells.find(kDateFollows, at + 1)) {
    const std::string_view digits = cells.substr(at + kDateFollows.size(), kDigits);
    if (digits.size() < kDigits) break;
    std::int64_t value = 0;
    for (const char digit : digits) value = value * kBase + static_cast<unsigned char>(digit);
    const Moment posted = nearest(value, kModulus, now);
    if (!dates || posted > dates->newest) dates = {.newest = posted, .points = {}};
  }
  return dates;
}

/// Each point once, in whatever order they are: its date, which stands at `offset`, and a hash of all of it.
std::vector<std::pair<std::uint32_t, std::size_t>> different_points(const Cloud& cloud, std::string_view data,
                                                                    std::size_t offset) {
  std::vector<std::pair<std::uint32_t, std::size_t>> points;
  points.reserve(data.size() / cloud.point_step);
  for (; data.size() >= cloud.point_step; data.remove_prefix(cloud.point_step)) {
    const std::string_view point = data.substr(0, cloud.point_step);
    std::uint32_t posted = 0;
    std::memcpy(&posted, point.data() + offset, sizeof posted);
    points.emplace_back(posted, std::hash<std::string_view>{}(point));
  }
  std::ranges::sort(points);
  const auto repeated = std::ranges::unique(points);
  points.erase(repeated.begin(), repeated.end());
  return points;
}

std::optional<Dates> dates_of_cloud(const Cloud& cloud, std::string_view data, Moment now) {
  const auto field = std::ranges::find(cloud.fields, "posted_ms", &CloudField::name);
  if (field == cloud.fields.end() || field->datatype != kUint32 || cloud.is_bigendian) return std::nullopt;
  const auto points = different_points(cloud, data, field->offset);
  if (points.empty()) return std::nullopt;
  std::map<std::uint32_t, std::uint64_t> counts;
  for (const auto& [posted, point] : points) ++counts[posted];
  Dates dates;
  for (const auto& [posted, count] : counts) {
    dates.points[nearest(posted, std::int64_t{1} << 32, now)] += count;
  }
  dates.newest = dates.points.rbegin()->first;
  return dates;
}

}  // namespace

std::optional<Dates> dates_of(const MapMessage& map, Moment now) {
  const auto* const cloud = std::get_if<Cloud>(&map.msg);
  return cloud != nullptr ? dates_of_cloud(*cloud, map.data, now) : dates_of_grid(map.data, now);
}

}  // namespace adit::rehearsal
