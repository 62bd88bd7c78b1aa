#include "rehearsal/command_post/arrivals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <functional>
#include <numeric>
#include <set>
#include <span>
#include <string_view>

#include "icd/sentence.hpp"
#include "rehearsal/common.hpp"

namespace adit::rehearsal {
namespace {

using Milliseconds = std::chrono::milliseconds;

constexpr std::int64_t kModulus = kDateBase * kDateBase * kDateBase * kDateBase * kDateBase;

/// When a map's data was posted, as adit-robots writes it into its maps (README.md, 'How old').
struct Dates {
  Moment newest;
  // Of a cloud: how many different points were posted then. A cloud that was joined of several has some of
  // them twice.
  std::map<Moment, std::uint64_t> points;
};

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
    const std::string_view digits = cells.substr(at + kDateFollows.size(), kDateDigits);
    if (digits.size() < kDateDigits) break;
    std::int64_t value = 0;
    for (const char digit : digits) value = value * kDateBase + static_cast<unsigned char>(digit);
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

/// Nothing of a map that tells no date. A date is read as the one nearest to `now`.
std::optional<Dates> dates_of(const MapMessage& map, Moment now) {
  const auto* const cloud = std::get_if<Cloud>(&map.msg);
  return cloud != nullptr ? dates_of_cloud(*cloud, map.data, now) : dates_of_grid(map.data, now);
}

constexpr int kDelete = 2, kDeleteAll = 3;
constexpr std::size_t kMostMarkers = 100'000, kMostRobots = 1000, kMostDifferences = 20;
constexpr double kSamePlace = 1e-3;  // metres: some robots post float32

constexpr std::size_t kMostSources = 200;
constexpr std::size_t kMostDates = 100'000;  // of one robot's points
constexpr Milliseconds kTick{10};            // by which ages are told apart
constexpr Milliseconds kOldest{3'600'000};
constexpr std::size_t kColumn = 8;  // characters

double share_of(std::uint64_t part, std::uint64_t all) {
  return all == 0 ? 1 : static_cast<double>(part) / static_cast<double>(all);
}

double seconds(Milliseconds time) {
  return std::chrono::duration<double>(time).count();
}

/// "12.3", or "-" where nothing was told.
std::string written(const OrderedJson& value, int digits) {
  if (value.is_null()) return "-";
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.*f", digits, value.get<double>());
  return text.data();
}

std::string percent(const OrderedJson& share) {
  return share.is_null() ? "-" : written(100 * share.get<double>(), 1) + "%";
}

}  // namespace

std::uint64_t Arrivals::Arrived::amount() const {
  const auto add = [](std::uint64_t sum, const auto& dated) { return sum + dated.second; };
  return cells.count() + std::accumulate(points.begin(), points.end(), std::uint64_t{0}, add);
}

double Arrivals::Arrived::age(double share) const {
  const double wanted = std::ceil(share * static_cast<double>(maps));
  std::uint64_t seen = 0;
  for (const auto& [age, count] : ages) {
    seen += count;
    if (static_cast<double>(seen) >= wanted) return seconds(age);
  }
  return 0;
}

Arrivals::Arrived* Arrivals::arrived(const std::string& robot, const std::string& kind) {
  const Source source{robot, kind};
  if (arrived_.size() >= kMostSources && !arrived_.contains(source)) return nullptr;
  return &arrived_[source];
}

void Arrivals::note(const MapMessage& map, Moment now) {
  const auto dates = dates_of(map, now);
  if (!dates) return;
  const std::lock_guard lock(mutex_);
  const auto* const grid = std::get_if<Grid>(&map.msg);
  Arrived* const here = arrived(map.name, grid != nullptr ? "grid" : "cloud");
  if (here == nullptr) return;
  ++here->maps;
  const auto age = std::chrono::floor<Milliseconds>(now - dates->newest);
  ++here->ages[std::clamp(age, Milliseconds(0), kOldest) / kTick * kTick];
  here->newest = std::max(here->newest, dates->newest);
  for (const auto& [date, points] : dates->points) {
    if (here->points.size() >= kMostDates && !here->points.contains(date)) continue;
    here->points[date] = std::max(here->points[date], points);
  }
  const std::span data(reinterpret_cast<const std::uint8_t*>(map.data.data()), map.data.size());
  if (const auto* const cloud = std::get_if<Cloud>(&map.msg)) {
    const Vector3 from = cloud->origin.value_or(Placement{}).position;
    return here->places.add(cloud->fields, cloud->point_step, data, {from.x, from.y, from.z});
  }
  const Vector3& corner = grid->origin.position;
  here->cells.add(grid->resolution, corner.x, corner.y, grid->width, data);
}

void Arrivals::note(const std::vector<MarkerChange>& changes, Findings& findings) {
  if (changes.empty()) return;
  const std::lock_guard lock(mutex_);
  for (const MarkerChange& change : changes) {
    const Key key{change.ns, change.id};
    if (change.action == kDeleteAll) standing_.clear();
    if (change.action == kDelete) standing_.erase(key);
    if (change.action == 0 && (standing_.size() < kMostMarkers || standing_.contains(key)))
      standing_[key] = change.x;
  }
  for (std::size_t id = changes.size(); id < before_; ++id) {
    if (standing_.erase({"", static_cast<std::int64_t>(id)}) == 0) continue;
    findings.tells(
        icd::sentence("markers: the organiser's display deletes id ", id,
                      " of an empty ns because this message has fewer markers than the previous one"));
  }
  before_ = changes.size();
}

bool Arrivals::told_maps(const Field& row) {
  const auto robot = row.text("robot"), kind = row.text("kind");
  const auto amount = row.integer("amount", 0, INT64_MAX), newest = row.integer("newest", 0, INT64_MAX);
  const auto told_places = row.optional_member("places");
  const auto places = told_places ? told_places->integer(0, INT64_MAX) : 0;
  if (!robot || !kind || !amount || !newest || !places) return false;
  if (Arrived* const here = arrived(*robot, *kind)) {
    here->posted = {.amount = static_cast<std::uint64_t>(*amount),
                    .places = static_cast<std::uint64_t>(*places),
                    .newest = Moment(Milliseconds(*newest))};
  }
  return true;
}

bool Arrivals::told_markers(const Field& row, const Field& standing) {
  const auto robot = row.text("robot");
  const auto markers = standing.elements();
  if (!robot || !markers || (should_.size() >= kMostRobots && !should_.contains(*robot))) return false;
  Places& places = should_[*robot] = {};
  for (const Field& marker : *markers) {
    const auto ns = marker.text("ns");
    const auto id = marker.integer("id", INT32_MIN, INT32_MAX);
    const auto x = marker.number("x");
    if (ns && id && x && places.size() < kMostMarkers) places[{*ns, *id}] = *x;
  }
  return true;
}

std::expected<void, std::string> Arrivals::told(const Json& posted) {
  Findings findings;
  const auto rows = Field(posted, "", findings).elements().value_or(std::vector<Field>{});
  const std::lock_guard lock(mutex_);
  for (const Field& row : rows) {
    const auto standing = row.optional_member("standing");
    if (!(standing ? told_markers(row, *standing) : told_maps(row))) break;
  }
  if (findings.all().empty()) return {};
  return std::unexpected(findings.all().front().sentence);
}

/// Between what stands and what should.
std::vector<std::string> Arrivals::differences() const {
  std::vector<std::string> all;
  std::set<std::string> told;  // namespaces of which some robot has told
  Places should;
  for (const auto& [robot, places] : should_) {
    for (const auto& [key, x] : places) told.insert(key.first);
    should.insert(places.begin(), places.end());
  }
  const auto text = [](const Key& key) { return icd::sentence("marker ", key.second, " of ", key.first); };
  for (const auto& [key, x] : should) {
    const auto found = standing_.find(key);
    if (found == standing_.end()) {
      all.push_back(text(key) + " is missing");
    } else if (std::abs(found->second - x) > kSamePlace) {
      all.push_back(text(key) + " is at x " + std::to_string(found->second) + ", not " + std::to_string(x));
    }
  }
  for (const auto& [key, x] : standing_) {
    if (told.contains(key.first) && !should.contains(key)) all.push_back(text(key) + " was deleted");
  }
  return all;
}

OrderedJson Arrivals::row(const Source& source, const Arrived& arrived) {
  OrderedJson row = {{"robot", source.first}, {"kind", source.second}, {"maps", arrived.maps}};
  const bool any = arrived.maps > 0;
  for (const auto& [name, share] : {std::pair{"p50", 0.5}, {"p99", 0.99}, {"most", 1.0}}) {
    row[name] = any ? OrderedJson(arrived.age(share)) : OrderedJson(nullptr);
  }
  row["behind"] = row["posted"] = row["share"] = row["places"] = nullptr;
  row["arrived"] = arrived.amount();
  if (!arrived.posted) return row;
  const auto& [amount, places, newest] = *arrived.posted;
  if (any) row["behind"] = std::max(0.0, seconds(newest - arrived.newest));
  row["posted"] = amount;
  row["share"] = share_of(arrived.amount(), amount);
  if (places > 0) row["places"] = share_of(arrived.places.count(), places);
  return row;
}

OrderedJson Arrivals::json() const {
  const std::lock_guard lock(mutex_);
  OrderedJson rows = OrderedJson::array();
  for (const auto& [source, arrived] : arrived_) rows.push_back(row(source, arrived));
  std::size_t should = 0;
  for (const auto& [robot, places] : should_) should += places.size();
  std::vector<std::string> first = differences();
  const std::size_t count = first.size();
  first.resize(std::min(count, kMostDifferences));
  const OrderedJson markers = {
      {"here", standing_.size()}, {"posted", should}, {"difference_count", count}, {"differences", first}};
  return {{"maps", rows}, {"markers", markers}};
}

std::string Arrivals::table() const {
  const OrderedJson all = json(), &rows = all["maps"], &markers = all["markers"];
  std::string text;
  if (!rows.empty()) {
    text =
        "age of maps at their arrival, in seconds; share of the posted maps that arrived\n"
        "  robot      kind    maps      p50     p99    most  behind    here  places\n";
  }
  for (const OrderedJson& row : rows) {
    const std::string robot = row["robot"];
    std::array<char, 64> line{};
    (void)std::snprintf(line.data(), line.size(), "  %-10.10s %-6.6s %5llu ",
                        robot.empty() ? "(merged)" : tame(robot).c_str(),
                        row["kind"].get_ref<const std::string&>().c_str(),
                        static_cast<unsigned long long>(row["maps"].get<std::uint64_t>()));
    text += line.data();
    for (const char* const age : {"p50", "p99", "most", "behind"})
      text += aligned_right(written(row[age], 2), kColumn);
    for (const char* const share : {"share", "places"}) text += aligned_right(percent(row[share]), kColumn);
    text += "\n";
  }
  if (markers["posted"] == 0) return text;
  text += icd::sentence("markers: ", markers["here"].dump(), " displayed, the robots have ",
                        markers["posted"].dump(), "; ", markers["difference_count"].dump(), " differ\n");
  for (const OrderedJson& sentence : markers["differences"]) text += "  " + sentence.dump() + "\n";
  return text;
}

}  // namespace adit::rehearsal
