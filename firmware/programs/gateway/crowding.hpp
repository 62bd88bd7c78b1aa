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

/// Rejected or closed connections and wrong tokens of the team's side: counts, shows the present ones, and
/// logs them once a minute.
class Crowding {
 public:
  static constexpr std::chrono::minutes kRecent{1}, kLogEvery{1};
  static constexpr std::size_t kMostAddresses = 64;

  struct Line {
    std::string sentence;
    std::uint64_t times;  // since the last log line
  };

  void ended(intake::Ended why, const std::string& address, loop::Instant now);
  std::uint64_t count(intake::Ended why) const { return at(why).count; }
  /// Of the last kRecent.
  std::vector<alarms::CrowdFact> crowds(loop::Instant now) const;
  /// Lines that are due.
  std::vector<Line> to_log(loop::Instant now);

 private:
  struct Kind {
    std::uint64_t count = 0, logged = 0;
    loop::Instant last{}, log_at{};
    std::map<std::string, std::uint64_t> by_address;  // in the present crowd
  };
  static constexpr std::array kTold{intake::Ended::NoRoom, intake::Ended::GaveWay, intake::Ended::WrongToken};

  const Kind& at(intake::Ended why) const { return kinds_[static_cast<std::size_t>(why)]; }
  std::string sentence(intake::Ended why) const;
  const std::string& most_of(intake::Ended why) const;

  std::array<Kind, intake::kEndedKinds> kinds_;
};

}  // namespace adit::gateway
