#include "simulation/courses.hpp"

#include <nlohmann/json.hpp>

#include "simulation/http.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr double kStay = 60;  // seconds at each course at the end; a run may end and begin meanwhile
constexpr int kMostTries = 10;

}  // namespace

int place_at(const std::string& address) {
  return address.starts_with("10.100.2.") ? 1 : 0;
}

Courses::Courses(World& world, const Faults& faults, double trouble_for)
    : first_(world, faults, trouble_for, 0), second_(world, faults, trouble_for, 1) {}

void Courses::calm() {
  first_.calm();
  second_.calm();
}

CommandPost& Courses::at(const uplink::Endpoint& endpoint) {
  return place_at(endpoint.address) == 0 ? first_ : second_;
}

std::optional<int> Courses::connecting(const uplink::Endpoint& endpoint) {
  return at(endpoint).connecting(endpoint);
}

std::unique_ptr<Peer> Courses::connected(const uplink::Endpoint& endpoint, Link& link) {
  return at(endpoint).connected(endpoint, link);
}

Switcher::Switcher(World& world, double trouble_for)
    : world_(world),
      client_(world, "10.0.0.13", {.keeps_alive = false, .patience = 20},
              world.random("client of the switcher")) {
  Random random = world.random("switcher");
  if (!random.chance(0.2)) return;
  bool other = false;
  const auto plan = [this, &other](double at) {
    other = !other;
    const char* const course = other ? kOtherCourse : "";
    world_.after(seconds(at), [this, course] { switch_to(course); });
  };
  double at = 0;
  for (std::uint64_t i = 1 + random.uniform_index(3); i > 0; --i) {
    at += random.uniform(3, 25);
    if (at < trouble_for) plan(at);
  }
  plan(trouble_for + kStay / 2);
  plan(trouble_for + kStay * 3 / 2);
}

/// A new wish replaces the earlier one.
void Switcher::switch_to(const std::string& course) {
  wanted_ = course;
  tries_ = kMostTries;
  go_on();
}

void Switcher::go_on() {
  if (!wanted_ || tries_ == 0 || client_.busy()) return;
  --tries_;
  const std::string headers =
      "Host: 10.0.0.1\r\nAuthorization: Bearer token-of-the-team\r\nContent-Type: application/json\r\n";
  client_.ask(http_request("POST", "/adit/course", headers, nlohmann::json{{"name", *wanted_}}.dump()),
              {.what = kCourse, .who = *wanted_}, [this, asked = *wanted_](int status) {
                if (status == 200) world_.note({.kind = Kind::Saved, .what = kCourse, .who = ""});
                if (status == 200 && wanted_ == asked) wanted_.reset();
                world_.after(seconds(1), [this] { go_on(); });
              });
}

}  // namespace adit::simulation
