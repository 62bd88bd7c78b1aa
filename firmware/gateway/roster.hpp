#pragma once

#include <map>
#include <string>
#include <vector>

#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::gateway {

/// Who of those that post is none of the robots that were set up: taken all the same (the ICD forbids no
/// name), but told of, as it may be misspelt.
class Roster {
 public:
  static constexpr std::chrono::minutes kRecent{2};  // for how long after its last message
  static constexpr std::size_t kMostUnknown = 8;

  explicit Roster(const std::vector<settings::Robot>& robots);

  /// These were set up, and no others, from now on.
  void set_up(const std::vector<settings::Robot>& robots);
  /// A robot's message was taken. True: an unknown one's first.
  bool posted(const std::string& name, loop::Instant now);
  /// Those that have posted lately.
  std::vector<std::string> unknown(loop::Instant now) const;
  /// "unknown robot 'x' is posting; set-up has ugv1, ugv2"
  std::string sentence(const std::string& name) const;
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::vector<std::string> names_;                // none: all are welcome
  std::map<std::string, loop::Instant> unknown_;  // and when each posted last
};

}  // namespace adit::gateway
