#pragma once

#include <optional>
#include <string>

#include "simulation/client.hpp"
#include "simulation/command_post.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// The course whose Command Post is the second one; "" is the first one's.
inline constexpr const char* kOtherCourse = "B";
/// Event::what of the operator's switching to a course; `who`: its name.
inline constexpr const char* kCourse = "course";
/// Which of the Command Posts is at such an address: 0 or 1.
int place_at(const std::string& address);

/// The Command Posts of two courses.
class Courses final : public Host {
 public:
  /// `world` outlives this.
  Courses(World& world, const Faults& faults, double trouble_for);

  /// No fault begins any more.
  void calm();
  std::optional<int> connecting(const uplink::Endpoint& endpoint) override;
  std::unique_ptr<Peer> connected(const uplink::Endpoint& endpoint, Link& link) override;

 private:
  CommandPost& at(const uplink::Endpoint& endpoint);
  CommandPost first_, second_;
};

/// In some runs: an operator who switches between them, and once the trouble is over goes to each once more,
/// so that what waits for it can go.
class Switcher {
 public:
  /// `world` outlives this.
  Switcher(World& world, double trouble_for);

 private:
  void switch_to(const std::string& course);
  void go_on();

  World& world_;
  Client client_;
  std::optional<std::string> wanted_;  // the course that he is to be told of
  int tries_ = 0;                      // that are left
};

}  // namespace adit::simulation
