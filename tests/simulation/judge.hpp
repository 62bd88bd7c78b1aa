#pragma once

#include <cstdint>
#include <deque>
#include <nlohmann/json.hpp>
#include <string>

#include "simulation/client.hpp"
#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// The operator's words, as the history calls them by Event::what.
inline constexpr const char *kSend = "send", *kHold = "hold", *kWithdraw = "withdraw", *kSettle = "settle",
                            *kCompose = "compose", *kCorrect = "correct", *kSendRejected = "send rejected";
/// As Event::who.
inline constexpr const char* kOperator = "operator";

/// An operator who looks at the page every few seconds and says what is to become of reports and of what is
/// rejected. He is truthful: before he judges a report in doubt he looks at the Command Post's own record.
class Judge {
 public:
  /// Until then all he does is drawn; after it he decides whatever waits for him. `world` outlives this.
  Judge(World& world, double trouble_for);

 private:
  struct Word {
    std::string path, what, body;
    std::int64_t serial;
  };
  void look();
  void viewed(const nlohmann::json& view);
  void classify_report(const nlohmann::json& row);
  void judge_held(std::int64_t number, std::int64_t serial);
  void correct(std::int64_t number, std::int64_t serial);
  void judge_aside(const nlohmann::json& row);
  void compose();
  void say(std::int64_t number, const char* what, std::int64_t serial);
  void say_next();
  /// In the run that is on at the Command Post that the settings name.
  bool is_recorded(std::int64_t serial) const;
  /// When Adit last sent that report, by the world's clock: the box's clock may have been set since.
  double left_at(std::int64_t serial) const;
  bool is_over() const;

  World& world_;
  Random random_;
  Client client_;
  const double trouble_for_;
  const bool looks_;  // while there is trouble
  const bool composes_;
  std::int64_t composed_ = 0;
  int place_ = 0;           // of the Command Post that the view names
  std::deque<Word> words_;  // to be said
};

}  // namespace adit::simulation
