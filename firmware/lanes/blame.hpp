#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace adit::lanes {

using Instant = std::chrono::steady_clock::time_point;

/// What is known of one message at which the Command Post's handler failed.
struct Trial {
  int failures = 0;  // in all
  int strikes = 0;   // of these: it alone failed, because others had passed since its last failure
  std::optional<Instant> failed{};  // last
  Instant rests_until{};            // others go first until then
  bool steps_behind = false;        // one other goes first

  bool rests(Instant now) const { return steps_behind || now < rests_until; }
};

/// Tells whether a message of one URI fails by its own fault, or because everything fails.
///
/// If the handler fails for everything, there is an outage: everything waits. If a message fails again and
/// again while others pass, it is at fault: each time it steps behind one other and rests longer, and after
/// kMostStrikes it is rejected. A strike does not count if another sender's messages passed and then failed
/// in between: then the Command Post wavers, and the message may still pass.
class Blame {
 public:
  static constexpr int kMostStrikes = 3;
  static constexpr std::chrono::seconds kFirstRest{2};  // after a strike; twice as long after each more
  static constexpr std::size_t kMostSenders = 1000;

  enum class Next { Again, Reject };

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
