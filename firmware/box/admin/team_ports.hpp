#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "loop/loop.hpp"
#include "network/messages.hpp"

namespace adit::admin {

/// Has the firewall open aditd's ports on the team's side and no others, by adit-network --ports.
class TeamPorts {
 public:
  /// Wait before a request is repeated that was read without an effect. An unread one stays.
  static constexpr std::chrono::seconds kAskAgain{60};

  /// `state_folder`: requests. `rules_folder`: of network::kPortRulesFile. `loop` must outlive this object.
  TeamPorts(loop::Loop& loop, std::string state_folder, std::string rules_folder)
      : loop_(loop), state_(std::move(state_folder)), rules_(std::move(rules_folder)) {}

  /// Call each second. Requests `ports` unless they are open and no others are.
  void every_second(const network::TeamPorts& ports);

 private:
  bool are_open(const network::TeamPorts& ports) const;

  loop::Loop& loop_;
  const std::string state_, rules_;
  network::TeamPorts asked_;
  std::optional<loop::Instant> asked_at_;  // std::nullopt: no request is unanswered
};

}  // namespace adit::admin
