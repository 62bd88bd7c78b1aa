#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>

#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// The operator's decisions, as Event::what.
inline constexpr const char *kSend = "send", *kHold = "hold", *kWithdraw = "withdraw", *kSettle = "settle",
                            *kCompose = "compose", *kCorrect = "correct", *kSendRejected = "send rejected";
/// Event::who of the operator.
inline constexpr const char* kOperator = "operator";

/// In two of five runs, an operator who looks at the page every few seconds. He holds, sends, withdraws and
/// corrects reports, decides about those in doubt, reports artifacts, and makes the lights flash. In every
/// run rejected messages are sent again once the trouble is over. Those requests are never left out, because
/// checks count on them.
/// Before he decides about a report in doubt he reads the Command Post's own record.
class DecidingOperator {
 public:
  /// His actions are random for `trouble_for` seconds; then he decides everything that needs a decision.
  /// `world` must outlive him.
  DecidingOperator(World& world, double trouble_for);

 private:
  struct Decision {
    std::string path, what, body;
    std::int64_t serial;
  };
  void look();
  void read_view(const nlohmann::json& view);
  void decide(const nlohmann::json& row);
  void decide_held(std::int64_t number, std::int64_t serial);
  void correct(std::int64_t number, std::int64_t serial);
  void decide_rejected(const nlohmann::json& row);
  void compose();
  void push_decision(std::int64_t number, const char* what, std::int64_t serial);
  void post_next();
  /// Whether the current run at the Command Post of the settings has recorded it.
  bool is_recorded(std::int64_t serial) const;
  /// When Adit last sent that report, by the world's clock, because the box's clock may have been set
  /// since.
  double left_at(std::int64_t serial) const;
  bool is_over() const;

  World& world_;
  Random random_;
  Client client_;
  const double trouble_for_;
  const bool looks_;  // at the page while there is trouble
  const bool composes_;
  std::int64_t composed_ = 0;
  int place_ = 0;                   // the Command Post of the view
  std::deque<Decision> decisions_;  // still to post
};

}  // namespace adit::simulation
