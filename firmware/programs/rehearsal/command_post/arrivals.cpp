#include "rehearsal/command_post/arrivals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numeric>
#include <span>

#include "rehearsal/command_post/fields.hpp"
#include "rehearsal/command_post/pictures.hpp"

namespace adit::rehearsal {
namespace {

using Milliseconds = std::chrono::milliseconds;

constexpr std::size_t kMostSources = 200;
constexpr std::size_t kMostDates = 100'000;  // of one robot's points
constexpr Milliseconds kTick{10};            // by which ages are told apart
constexpr Milliseconds kOldest{3'600'000};

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
    const Point from = cloud->origin.value_or(Pose{}).position;
    return here->places.add(cloud->fields, cloud->point_step, data, {from.x, from.y, from.z});
  }
  const Point& corner = grid->origin.position;
  here->cells.add(grid->resolution, corner.x, corner.y, grid->width, data);
}

std::expected<void, std::string> Arrivals::told(const Json& posted) {
  Findings findings;
  const auto all = Field(posted, "", findings).elements();
  const std::lock_guard lock(mutex_);
  for (const Field& one : all.value_or(std::vector<Field>{})) {
    if (one.optional_member("standing")) continue;  // markers: of MarkerDisplay
    const auto robot = one.member("robot"), kind = one.member("kind");
    const auto amount = one.member("amount"), newest = one.member("newest");
    if (!robot || !kind || !amount || !newest) break;
    const auto name = robot->text(), of = kind->text();
    const auto count = amount->integer(0, INT64_MAX), at = newest->integer(0, INT64_MAX);
    const auto told_places = one.optional_member("places");
    const auto places = told_places ? told_places->integer(0, INT64_MAX) : 0;
    if (!name || !of || !count || !at || !places) break;
    if (Arrived* const here = arrived(*name, *of)) {
      here->posted = {.amount = static_cast<std::uint64_t>(*count),
                      .places = static_cast<std::uint64_t>(*places),
                      .newest = Moment(Milliseconds(*at))};
    }
  }
  if (findings.all().empty()) return {};
  return std::unexpected(findings.all().front().sentence);
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
  return rows;
}

std::string Arrivals::table() const {
  const OrderedJson rows = json();
  if (rows.empty()) return "";
  std::string text = "age of maps at their arrival, in seconds; share of the posted maps that arrived\n";
  text += "  robot      kind    maps      p50     p99    most  behind    here  places\n";
  for (const OrderedJson& row : rows) {
    const std::string robot = row["robot"];
    std::array<char, 160> line{};
    (void)std::snprintf(
        line.data(), line.size(), "  %-10.10s %-6.6s %5llu %8s%8s%8s%8s%8s%8s\n",
        robot.empty() ? "(merged)" : tame(robot).c_str(), row["kind"].get_ref<const std::string&>().c_str(),
        static_cast<unsigned long long>(row["maps"].get<std::uint64_t>()), written(row["p50"], 2).c_str(),
        written(row["p99"], 2).c_str(), written(row["most"], 2).c_str(), written(row["behind"], 2).c_str(),
        percent(row["share"]).c_str(), percent(row["places"]).c_str());
    text += line.data();
  }
  return text;
}

}  // namespace adit::rehearsal
