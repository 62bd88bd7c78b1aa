#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "alarms/facts.hpp"
#include "intake/server.hpp"
#include "loop/loop.hpp"

namespace adit::gateway {

/// What becomes of the team's connections where there are too many, and of who shows wrong tokens: counted,
/// told of for as long as it goes on, and logged once a minute.
class Crowding {
 public:
  static constexpr std::chrono::minutes kRecent{1}, kLogEvery{1};
  static constexpr std::size_t kMostAddresses = 64;

  struct Line {
    std::string sentence;
    std::uint64_t times;  // since it was logged last
  };

  void ended(intake::Ended why, const std::string& address, loop::Instant now);
  std::uint64_t count(intake::Ended why) const { return at(why).count; }
  /// What goes on now.
  std::vector<alarms::Crowd> crowds(loop::Instant now) const;
  /// What is to be logged now.
  std::vector<Line> to_log(loop::Instant now);

 private:
  struct Kind {
    std::uint64_t count = 0, logged = 0;
    loop::Instant last{}, log_at{};
    std::map<std::string, std::uint64_t> by_address;  // since its start
  };
  static constexpr std::array kTold{intake::Ended::NoRoom, intake::Ended::GaveWay, intake::Ended::WrongToken};

  const Kind& at(intake::Ended why) const { return kinds_[static_cast<std::size_t>(why)]; }
  std::string sentence(intake::Ended why) const;
  const std::string& most_of(intake::Ended why) const;

  std::array<Kind, intake::kEndedKinds> kinds_;
};

}  // namespace adit::gateway
