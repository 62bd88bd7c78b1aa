#pragma once

#include <optional>
#include <string>

#include "simulation/client.hpp"
#include "simulation/command_post.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// The course of the second Command Post; the first one's course is "".
inline constexpr const char* kOtherCourse = "B";
/// Event::what if the operator switches the course; `who` is the course.
inline constexpr const char* kCourse = "course";
/// The index of the Command Post at that address: 0 or 1.
int place_at(const std::string& address);

/// The two Command Posts of two courses.
class Courses final : public Host {
 public:
  /// `world` must outlive them.
  Courses(World& world, const Faults& faults, double trouble_for);

  /// Ends all faults.
  void calm();
  std::optional<int> connecting(const uplink::Endpoint& endpoint) override;
  std::unique_ptr<Peer> connected(const uplink::Endpoint& endpoint, Link& link) override;

 private:
  CommandPost& at(const uplink::Endpoint& endpoint);
  CommandPost first_, second_;
};

/// In some runs, an operator who switches between the courses. Once the trouble is over he goes to each
/// course once more, so that messages queued for it can be sent.
class Switcher {
 public:
  /// `world` must outlive it.
  Switcher(World& world, double trouble_for);

 private:
  void switch_to(const std::string& course);
  void go_on();

  World& world_;
  Client client_;
  std::optional<std::string> wanted_;  // the course to switch to
  int tries_ = 0;                      // tries left
};

}  // namespace adit::simulation
