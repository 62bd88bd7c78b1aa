#include "rehearsal/robots/explorer.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace adit::robots {
namespace {

constexpr double kPathEvery = 2;     // metres
constexpr double kCommsEvery = 12;   // metres
constexpr int kPathNodes = 60;       // that stand at a time
constexpr double kCandidateFor = 8;  // seconds
constexpr std::size_t kWayPoints = 400;

using namespace std::chrono_literals;
using std::chrono::milliseconds;

constexpr milliseconds kTick = 100ms;
constexpr double kReportNoise = 0.05;  // metres
constexpr double kWrongReports = 0.15;

/// A task at regular times. Missed times are not made up for.
class PeriodicTimer {
 public:
  PeriodicTimer(std::chrono::duration<double> period, std::chrono::steady_clock::time_point first)
      : period_(std::chrono::duration_cast<milliseconds>(period)), next_(first) {}
  bool due(std::chrono::steady_clock::time_point now) {
    if (now < next_) return false;
    next_ = std::max(next_ + period_, now);
    return true;
  }

 private:
  milliseconds period_;
  std::chrono::steady_clock::time_point next_;
};

/// Most robots keep the time of day, more or less; every third counts from its boot.
double clock_of(std::size_t index, Random& random) {
  if (index % 3 == 2) return random.uniform(60, 600);
  const std::chrono::duration<double> now = std::chrono::system_clock::now().time_since_epoch();
  return now.count() + random.uniform(-3, 3);
}

}  // namespace

void MarkerScene::change(Marker marker) {
  standing_[{marker.ns, marker.id}] = marker;
  changes_.push_back(std::move(marker));
}

void MarkerScene::remove(const std::string& ns, int id) {
  auto gone = standing_.extract({ns, id});
  gone.mapped().action = Marker::Delete;
  changes_.push_back(std::move(gone.mapped()));
}

/// A trajectory, as the ICD names them (2.2), and at its end the robot's own shape.
void MarkerScene::draw_way(const Vector3& position) {
  way_.push_back(position);
  if (way_.size() > kWayPoints) way_.erase(way_.begin());
  change({.ns = robot_ + "/way",
          .type = Marker::LineStrip,
          .size = 0.05,
          .color = {.r = 0, .g = 1, .b = 0},
          .points = way_});
  change({.ns = robot_ + "/shape",
          .type = Marker::Mesh,
          .position = position,
          .size = 1,
          .color = {.r = 0.8, .g = 0.8, .b = 0.8},
          .mesh_resource = "package://rehearsal/meshes/robot.dae"});
}

void MarkerScene::pass(const Vector3& position, double walked, double seconds) {
  const std::string path = robot_ + "/path";
  if (walked >= path_nodes_ * kPathEvery) {
    draw_way(position);
    change({.ns = path,
            .id = path_nodes_++,
            .position = position,
            .size = 0.2,
            .color = {.r = 0, .g = 0.75, .b = 1}});
  }
  if (path_nodes_ - oldest_node_ > kPathNodes) remove(path, oldest_node_++);
  if (walked >= comm_nodes_ * kCommsEvery) {
    change({.ns = robot_ + "/comms",
            .id = comm_nodes_++,
            .type = Marker::Cube,
            .position = position,
            .size = 0.4,
            .color = {.r = 1, .g = 0.5, .b = 0}});
  }
  while (!candidates_until_.empty() && candidates_until_.begin()->second <= seconds) {
    remove(robot_ + "/artifact", candidates_until_.begin()->first);
    candidates_until_.erase(candidates_until_.begin());
  }
}

void MarkerScene::candidate(const std::string& type, const Vector3& position, double seconds) {
  candidates_until_[candidates_] = seconds + kCandidateFor;
  change({.ns = robot_ + "/artifact",
          .id = candidates_++,
          .type = Marker::Text,
          .position = position,
          .size = 0.6,
          .color = {.r = 1, .g = 0.25, .b = 0.25},
          .lifetime = 600,
          .text = type + "?"});
}

std::vector<Marker> MarkerScene::standing() const {
  std::vector<Marker> all;
  all.reserve(standing_.size());
  for (const auto& [key, marker] : standing_) all.push_back(marker);
  return all;
}

std::vector<Marker> MarkerScene::take_changes() {
  if (++calls_ % 10 == 0) std::ranges::move(standing(), std::back_inserter(changes_));
  return std::exchange(changes_, {});
}

void PostedTotals::note(const std::string& robot, MessageKind kind, const Amount& amount) {
  const std::scoped_lock lock(mutex_);
  amounts_[{robot, kind}] = amount;
}

void PostedTotals::note(const std::string& robot, const std::vector<Marker>& standing) {
  const std::scoped_lock lock(mutex_);
  standing_[robot] = standing;
}

std::string PostedTotals::json() const {
  const std::scoped_lock lock(mutex_);
  auto all = nlohmann::json::array();
  for (const auto& [source, posted] : amounts_) {
    all.push_back({{"robot", source.first},
                   {"kind", name_of(source.second)},
                   {"amount", posted.amount},
                   {"places", posted.places},
                   {"newest", posted.newest.time_since_epoch().count()}});
  }
  for (const auto& [robot, markers] : standing_) {
    auto standing = nlohmann::json::array();
    for (const Marker& marker : markers)
      standing.push_back({{"ns", marker.ns}, {"id", marker.id}, {"x", marker.position.x}});
    all.push_back({{"robot", robot}, {"kind", "markers"}, {"standing", std::move(standing)}});
  }
  return all.dump();
}

std::string arrivals_of(const PostedTotals& posted, const Address& control) {
  constexpr std::chrono::seconds kLongest{5};
  const auto reply = Connection(control, {})
                         .exchange({.method = "POST",
                                    .target = "/posted",
                                    .fields = {{"Content-Type", "application/json"}},
                                    .body = posted.json()},
                                   kLongest);
  if (!reply) return "--control: " + reply.error() + "\n";
  const auto answer = nlohmann::json::parse(reply->body, nullptr, false);
  if (reply->status != 200 || !answer.is_object() || !answer.contains("table") ||
      !answer["table"].is_string())
    return "--control: the server is not a control port of adit-rehearsal\n";
  return answer["table"];
}

Explorer::Explorer(const Cave& cave, std::uint64_t seed, std::size_t index, std::string name,
                   const Style& style, const MapOffer& offer, Client& client, OperatorClient& desk,
                   PostedTotals& posted)
    : cave_(cave),
      index_(index),
      name_(std::move(name)),
      style_(style),
      client_(client),
      desk_(desk),
      posted_(posted),
      random_(seed * 7'919 + index),
      robot_(cave, seed, index),
      scene_(name_),
      maps_(offer, seed * 104'729 + index),
      clock_at_start_(clock_of(index, random_)),
      start_(Clock::now()) {}

double Explorer::stamp(Clock::time_point now) const {
  return clock_at_start_ + std::chrono::duration<double>(now - start_).count();
}

MapTime Explorer::map_time(Clock::time_point now) const {
  return {stamp(now), std::chrono::floor<milliseconds>(std::chrono::system_clock::now())};
}

/// A message without a name belongs to no robot.
void Explorer::post_grid(Clock::time_point now) {
  const MapTime time = map_time(now);
  auto grid = maps_.grid(robot_.map(), robot_.pose().position, time);
  if (!grid) return;
  if (!style_.ros) posted_.note(name_, MessageKind::Grid, {.amount = maps_.cells(), .newest = time.posted});
  client_.send(*std::move(grid));
}

void Explorer::post_cloud(Clock::time_point now) {
  const MapTime time = map_time(now);
  auto cloud = maps_.cloud(robot_.map(), robot_.pose().position, time);
  if (!cloud) return;
  if (!style_.ros) {
    posted_.note(name_, MessageKind::Cloud,
                 {.amount = maps_.points(), .places = maps_.places(), .newest = time.posted});
  }
  client_.send(*std::move(cloud));
}

/// The first robot that sees an artifact reports it, some centimetres off; at times it reports a rock.
void Explorer::report_sightings(double seconds) {
  for (const std::size_t artifact : robot_.take_sightings()) {
    const Artifact& seen = cave_.artifacts()[artifact];
    scene_.candidate(seen.type, seen.position, seconds);
    if (!desk_.is_news(artifact)) continue;
    Report report = seen;
    report.position.x += random_.noise(kReportNoise);
    report.position.y += random_.noise(kReportNoise);
    report.position.z += random_.noise(kReportNoise);
    desk_.submit({name_, &style_, report});
    if (!random_.chance(kWrongReports)) continue;
    const double direction = random_.uniform(0, 2 * std::numbers::pi), far = random_.uniform(20, 30);
    report.position.x += far * std::cos(direction);
    report.position.y += far * std::sin(direction);
    desk_.submit({name_, &style_, report});
  }
}

void Explorer::work(double metres_per_second, const std::stop_token& finish) {
  PeriodicTimer state(index_ % 2 == 0 ? kTick : 2 * kTick, start_);
  PeriodicTimer grid(maps_.offer().grid_every, start_ + 50ms);
  PeriodicTimer cloud(maps_.offer().cloud_every, start_ + 150ms);
  PeriodicTimer markers(2000ms, start_ + 250ms);
  Clock::time_point before = start_;
  while (!finish.stop_requested()) {
    const Clock::time_point now = Clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    // A robot that waited long for an answer does not fly through the cave.
    robot_.advance(metres_per_second * std::min(std::chrono::duration<double>(now - before).count(), 1.0));
    before = now;
    scene_.pass(robot_.pose().position, robot_.walked_distance(), seconds);
    report_sightings(seconds);

    if (state.due(now)) client_.send(RobotState{stamp(now), name_, robot_.pose()});
    if (grid.due(now)) post_grid(now);
    if (cloud.due(now)) post_cloud(now);
    if (markers.due(now)) {
      if (Markers changed{stamp(now), scene_.take_changes()}; !changed.markers.empty())
        client_.send(std::move(changed));
      posted_.note(name_, scene_.standing());
    }
    sleep_until(now + kTick, finish);
  }
}

}  // namespace adit::robots
