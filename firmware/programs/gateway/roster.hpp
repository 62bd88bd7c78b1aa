#pragma once

#include <map>
#include <string>
#include <vector>

#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// Robots that are not in the settings. Their messages are accepted, because the ICD forbids no name, but
/// shown, because the name may be misspelt.
class Roster {
 public:
  static constexpr std::chrono::minutes kRecent{2};  // since the last message
  static constexpr std::size_t kMostUnknown = 8;

  explicit Roster(const std::vector<settings::Robot>& robots);

  /// Replaces the list.
  void set_up(const std::vector<settings::Robot>& robots);
  /// Call for each accepted message. True: the first of an unknown robot.
  bool posted(const std::string& name, loop::Instant now);
  /// Within kRecent.
  std::vector<std::string> unknown(loop::Instant now) const;
  /// "unknown robot 'x' sends messages; the settings list ugv1, ugv2"
  std::string sentence(const std::string& name) const;
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;                // empty: all names pass
  std::map<std::string, loop::Instant> unknown_;  // last messages
};

}  // namespace adit::gateway
