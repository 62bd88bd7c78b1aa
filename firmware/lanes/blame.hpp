#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace adit::lanes {

using Instant = std::chrono::steady_clock::time_point;

/// What is known of one message at which the Command Post's handler failed.
struct Trial {
  int failures = 0;                 // in all
  int strikes = 0;                  // of these: it failed alone, for others had passed since it failed before
  std::optional<Instant> failed{};  // last
  Instant rests_until{};            // others go first until then
  bool steps_behind = false;        // one other goes first

  bool rests(Instant now) const { return steps_behind || now < rests_until; }
};

/// Whose fault it is that messages of one URI fail: the message's own, or everybody's.
///
/// A handler that fails for everything is an outage, and nobody's fault: everything waits. A message is at
/// fault that fails again and again while others pass: it steps behind one other, rests longer each time, and
/// after kMostStrikes is set aside. A strike is void where somebody else's messages went from passing to
/// failing in between: then the Command Post wavers, and what failed may pass.
class Blame {
 public:
  static constexpr int kMostStrikes = 3;
  static constexpr std::chrono::seconds kFirstRest{2};  // after a strike; twice as long after each more
  static constexpr std::size_t kMostSenders = 1000;

  enum class Next { Again, SetAside };

  /// A message of `whose` (a robot's maps of one kind) was taken.
  void passed(const std::string& whose, Instant now);
  /// One failed; `trial` is its own.
  Next failed(const std::string& whose, Trial& trial, Instant now);

 private:
  struct Sender {
    bool passes = false;             // the last one did
    std::optional<Instant> wavered;  // one failed after one had passed
  };
  bool somebody_wavered(const std::string& but, Instant since) const;
  Sender& sender(const std::string& whose);

  std::map<std::string, Sender> senders_;
  std::optional<Instant> last_passed_;
};

}  // namespace adit::lanes
