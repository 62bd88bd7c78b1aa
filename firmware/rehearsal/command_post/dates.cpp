#include "rehearsal/command_post/dates.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <string_view>

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

std::optional<Dates> dates_of_cloud(const Cloud& cloud, std::string_view data, Moment now) {
  const auto field = std::ranges::find(cloud.fields, "posted_ms", &CloudField::name);
  if (field == cloud.fields.end() || field->datatype != kUint32 || cloud.is_bigendian) return std::nullopt;
  std::map<std::uint32_t, std::uint64_t> counts;
  auto known = counts.end();
  std::uint64_t together = 0;  // points of that date, one after the other
  for (std::size_t at = 0; at + cloud.point_step <= data.size(); at += cloud.point_step) {
    std::uint32_t posted = 0;
    std::memcpy(&posted, data.data() + at + field->offset, sizeof posted);
    if (known == counts.end() || known->first != posted) {
      known = counts.try_emplace(posted).first;
      together = 0;
    }
    known->second = std::max(known->second, ++together);
  }
  if (counts.empty()) return std::nullopt;
  Dates dates;
  for (const auto& [posted, points] : counts) {
    dates.points[nearest(posted, std::int64_t{1} << 32, now)] += points;
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
