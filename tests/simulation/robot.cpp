#include "simulation/robot.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "simulation/manners.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr int kWritings = 80;
constexpr int kLargest = 64;            // cells per side
constexpr std::size_t kLongestMap = 8;  // clouds until its map begins again
constexpr int kLargeGrids = 3;          // in some worlds of large maps
constexpr int kOfLargeCloud = 60;       // points, at least
constexpr int kLargeClouds = 6;         // in a world of large maps
constexpr double kJump = 6;  // seconds; a clock that was set back by less is soon past its latest stamp
constexpr double kLongestBacklog = 40;  // seconds

Style style(const World& world, const std::string& name) {
  Random random = world.random("style " + name), ros = world.random("ros style of " + name);
  const bool has_ros = world.random("whole ros messages").chance(0.2);
  return {.cbor = random.chance(0.5),
          .gzip = random.chance(0.3),
          .gzip_data = random.chance(0.3),
          .big_endian = random.chance(0.2),
          .point_step = random.chance(0.7) ? 16 : 24,
          .news_first = random.chance(0.5),
          .in_rows = has_ros && ros.chance(0.5),
          .quaternion = has_ros && ros.chance(0.5) ? 2.0 : 1.0};
}

int between(Random& random, int low, int high) {
  return low + static_cast<int>(random.uniform_index(static_cast<std::uint64_t>(high - low + 1)));
}

}  // namespace

Robot::Robot(World& world, int number)
    : world_(world),
      number_(number),
      random_(world.random("robot " + std::to_string(number))),
      name_(std::string("R").append(std::to_string(number))),
      finds_ns_(world.random("finds of " + name_).chance(0.3) ? "" : name_ + " finds"),
      client_(world, address(number), manners(random_), world.random("client " + name_)),
      slowly_(world.random("slow posts of " + name_)),
      overtakes_(slowly_.chance(0.25)),
      slow_client_(world, address(number), {.patience = 30, .pauses = 1},
                   world.random("slow client " + name_)),
      style_(style(world, name_)),
      clock_(random_.uniform(-1000, 1000)),
      jump_(random_.chance(0.3) ? (random_.chance(0.5) ? 1 : -1) * random_.uniform(kJump, 2000) : 0),
      jumps_at_(random_.uniform(1, 60)),
      stamps_(random_.chance(0.7)),
      logs_(world.random("log of " + name_)),
      has_backlog_(stamps_ && jump_ == 0 && logs_.chance(0.3)),
      log_client_(world, address(number), {.patience = 30}, world.random("log client " + name_)),
      every_(random_.uniform(0.1, 2)),
      wipes_(random_.chance(0.5) ? 0.1 : 0),
      writings_(world.random("writings of " + name_).chance(0.01) ? kWritings : 0),
      serial_(number * kSerials),
      whole_(world.random("whole clouds of " + name_).chance(0.3)),
      rolls_(world.random("rolling grids of " + name_).chance(0.3)),
      drift_(world.random("drift of " + name_)),
      jitters_(drift_.chance(0.25)),
      creeps_(!jitters_ && drift_.chance(0.25)),
      fade_(world.random("lifetimes of " + name_)),
      fades_(fade_.chance(0.3)),
      large_(number == 1 && world.has_large_maps() ? kLargeClouds : 0),
      large_grids_(number == 1 && world.has_large_grids() ? kLargeGrids : 0),
      noise_(1000 + world.random("noise of " + name_).uniform_index(3000)) {}

void Robot::post_until(double end) {
  end_ = end;
  if (has_backlog_) world_.after(seconds(logs_.uniform(0, end)), [this] { fill_backlog(); });
  world_.after(seconds(random_.uniform(0, every_)), [this] { post(); });
}

void Robot::post() {
  if (world_.time() > end_) return;
  const Posting posting = next();
  Style style = style_;
  const bool is_cloud = posting.path == kMap && !is_grid(posting.items.front().says);
  if (is_cloud && large_-- > 0) style.noise = noise_;
  if (overtakes_ && slowly_.chance(0.25) && !slow_client_.busy()) {
    slow_client_.ask_several(request_of(posting, style), events_of(posting), [](int) {});
    return post_later();
  }
  client_.ask_several(request_of(posting, style), events_of(posting), [this](int) { post_later(); });
}

void Robot::post_later() {
  const double pause = row_ > 0 ? 0.01 : every_ * random_.uniform(0.2, 1.8);
  world_.after(seconds(pause), [this] { post(); });
}

void Robot::fill_backlog() {
  const double now = world_.time(), span = std::min(now, logs_.uniform(2, kLongestBacklog));
  const std::uint64_t poses = 5 + logs_.uniform_index(60);
  for (std::uint64_t i = 1; i <= poses; ++i)
    backlog_.push_back(now - span * static_cast<double>(i) / static_cast<double>(poses));
  if (logs_.chance(0.7)) std::ranges::reverse(backlog_);  // the newest comes last
  std::ranges::reverse(backlog_);
  post_backlog();
}

void Robot::post_backlog() {
  if (backlog_.empty() || world_.time() > end_) return;
  const double late = world_.time() - backlog_.back();
  backlog_.pop_back();
  Posting posting{kState, {item(name_, {number_, static_cast<int>(late * 1000)})}};
  posting.items.front().stamp -= late;
  log_client_.ask_several(request_of(posting, style_), events_of(posting), [this](int) {
    world_.after(seconds(logs_.uniform(0.005, 0.2)), [this] { post_backlog(); });
  });
}

Posting Robot::next() {
  if (row_ > 0) {
    --row_;
    if (row_of_grids_) return {kMap, {grid()}};
    return clouds();
  }
  if (writings_ > 0 && random_.chance(0.5)) return markers();
  const double kind = random_.unit();
  if (kind < 0.35) return {kState, {item(name_, {number_})}};
  row_of_grids_ = rolls_ && kind < 0.55;
  if (row_of_grids_) row_ = 1 + random_.uniform_index(5);
  if (kind < 0.55) return {kMap, {grid()}};
  if (kind < 0.8) return markers();
  if (random_.chance(0.4)) row_ = 1 + random_.uniform_index(5);
  return clouds();
}

Item Robot::item(std::string who, Says says) {
  const double off = clock_ + (world_.time() > jumps_at_ ? jump_ : 0);
  return {.who = std::move(who),
          .serial = ++serial_,
          .stamp = stamps_ ? World::kEpoch + world_.time() + off : 0,
          .says = std::move(says)};
}

/// The first ones may be large. Half of the next ones are its whole map, which grows. The others are patches
/// at any place, some on another lattice.
Item Robot::grid() {
  if (large_grids_ > 0) {
    --large_grids_;
    return item(name_, large_grid_.says());
  }
  if (rolls_ && random_.chance(0.9)) return window();
  if (random_.chance(0.5)) {
    if (random_.chance(0.2) && extent_.width < kLargest) ++extent_.width, ++extent_.height;
    if (random_.chance(0.1)) extent_.x -= extent_.cell, ++extent_.width;
    return item(name_, moved(extent_).says());
  }
  const int cell = random_.chance(0.8) ? 500 : 250;
  const Extent patch{.cell = cell,
                     .x = cell * between(random_, -8, 8) + (random_.chance(0.1) ? cell / 2 : 0),
                     .y = cell * between(random_, -8, 8),
                     .width = between(random_, 2, 12),
                     .height = between(random_, 2, 12)};
  return item(name_, patch.says());
}

/// The extent as SLAM has corrected the frame this time. No two origins are half a cell apart.
Extent Robot::moved(Extent extent) {
  constexpr int kMost = 110, kStep = 90, kRise = 30, kSteps = 100;  // millimetres, of a cell of 500; steps
  if (jitters_) {
    extent.x += between(drift_, -kMost, kMost);
    extent.y += between(drift_, -kMost, kMost);
    extent.z = between(drift_, -1, 1);
  }
  if (creeps_) {
    crept_ = (crept_ + 1) % kSteps;
    extent.x += kStep * crept_;
    extent.z = kRise * (crept_ % 10);
  }
  return extent;
}

Item Robot::window() {
  const int farthest = 30 * window_.cell;
  window_.x = std::clamp(window_.x + window_.cell * between(random_, -1, 3), -farthest, farthest);
  window_.y = std::clamp(window_.y + window_.cell * between(random_, -1, 3), -farthest, farthest);
  if (window_.x == farthest || window_.y == farthest) window_.x = window_.y = -farthest;
  return item(name_, moved(window_).says());
}

/// Some clouds have no robot's name.
Item Robot::cloud() {
  const int points = between(random_, 5, random_.chance(0.1) ? 300 : 60);
  return item(random_.chance(0.8) ? name_ : "",
              {large_ > 0 ? kOfLargeCloud + points % kOfLargeCloud : points});
}

Posting Robot::clouds() {
  const Item news = cloud();
  if (!whole_ || news.who.empty()) return {kMap, {news}};
  if (recent_clouds_.size() == kLongestMap) recent_clouds_.clear();
  recent_clouds_.insert(recent_clouds_.begin(), news);
  return {kMap, recent_clouds_};
}

/// Up to four changes of its own namespaces in one message. In some runs it deletes all markers, including
/// those of others.
Posting Robot::markers() {
  Posting posting{kMarkers, {}};
  for (std::uint64_t i = 1 + random_.uniform_index(4); i > 0; --i) {
    const int action = random_.chance(wipes_) ? kDeleteAll : random_.chance(0.25) ? kDelete : kAdd;
    const bool is_line = random_.chance(0.5), is_text = is_line && writings_ > 0;
    if (is_text) --writings_;
    const std::string ns = is_text ? name_ + kWriting : is_line ? name_ + kPath : finds_ns_;
    const int lifetime = fades_ && action == kAdd && fade_.chance(0.5) ? between(fade_, 100, 20'000) : 0;
    posting.items.push_back(item(ns, {action, between(random_, 0, 5), lifetime}));
  }
  return posting;
}

}  // namespace adit::simulation
