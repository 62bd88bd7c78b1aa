#include "simulation/team.hpp"

#include <cmath>

#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr int kMostTries = 12;
constexpr std::int64_t kReportsOfOne = 1000;  // serials of one reporter

std::string address(int number) {
  return std::string("10.0.0.").append(std::to_string(20 + number));
}

Manners manners(Random random) {
  return {.keeps_alive = random.chance(0.6),
          .patience = random.chance(0.5) ? random.between(0.3, 3) : random.between(3, 30),
          .hangs_up = random.chance(0.3) ? random.between(0.02, 0.3) : 0,
          .dribbles = random.chance(0.3) ? 0.5 : 0.05};
}

Style style(Random random) {
  return {.cbor = random.chance(0.5), .gzip = random.chance(0.3), .gzip_data = random.chance(0.3)};
}

}  // namespace

Robot::Robot(World& world, int number)
    : world_(world),
      random_(world.random("robot " + std::to_string(number))),
      name_(std::string("R").append(std::to_string(number))),
      client_(world, address(number), manners(random_), world.random("client " + name_)),
      style_(style(world.random("style " + name_))),
      clock_(random_.between(-1000, 1000)),
      stamps_(random_.chance(0.7)),
      every_(random_.between(0.1, 2)) {}

void Robot::post_until(double end) {
  end_ = end;
  world_.after(seconds(random_.between(0, every_)), [this] { post(); });
}

void Robot::post() {
  if (world_.time() > end_) return;
  Posting posting{.path = kState, .who = name_, .serial = ++serial_, .stamp = 0};
  if (stamps_) posting.stamp = world_.stamp() + clock_;
  const double kind = random_.unit();
  if (kind > 0.5) posting.path = kind > 0.75 ? kMap : kMarkers;
  if (random_.chance(0.1) && size_ < 64) ++size_;  // a newer grid covers the older
  posting.size = size_;
  client_.ask(request_of(posting, style_),
              {.what = posting.path, .who = name_, .serial = posting.serial, .stamp = posting.stamp},
              [this](int) { world_.after(seconds(every_ * random_.between(0.2, 1.8)), [this] { post(); }); });
}

Reporter::Reporter(World& world, int number)
    : world_(world),
      random_(world.random("reporter " + std::to_string(number))),
      client_(world, address(100 + number), manners(random_),
              world.random("client of reporter " + std::to_string(number))),
      number_(number),
      every_(random_.between(0.5, 10)),
      serial_(number * kReportsOfOne) {}

void Reporter::report_until(double end) {
  end_ = end;
  world_.after(seconds(random_.between(0, every_)), [this] {
    ++serial_;
    report();
  });
}

void Reporter::report() {
  if (world_.time() > end_) return;
  client_.ask(request_of({.path = kReports, .who = "", .serial = serial_}, {}),
              {.what = kReports, .who = "", .serial = serial_}, [this](int status) { answered(status); });
}

void Reporter::answered(int status) {
  const bool again = (status == 0 || status >= 500 || status == 429) && ++tries_ < kMostTries;
  if (again) return world_.after(seconds(random_.between(0.05, 2)), [this] { report(); });
  tries_ = 0;
  ++serial_;
  world_.after(seconds(every_ * random_.between(0.2, 1.8)), [this] { report(); });
}

Team::Team(World& world, double until) {
  Random random = world.random("team");
  const auto robots = static_cast<int>(random.below(4)), reporters = static_cast<int>(random.below(3));
  for (int i = 1; i <= robots; ++i) robots_.push_back(std::make_unique<Robot>(world, i));
  for (int i = 1; i <= reporters; ++i) reporters_.push_back(std::make_unique<Reporter>(world, i));
  for (const auto& robot : robots_) robot->post_until(until);
  for (const auto& reporter : reporters_) reporter->report_until(until);
}

}  // namespace adit::simulation
