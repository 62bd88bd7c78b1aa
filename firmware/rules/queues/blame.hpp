#pragma once

#include <chrono>
#include <map>
#include <optional>
#include <string>

namespace adit::queues {

using Instant = std::chrono::steady_clock::time_point;

/// The failures of one message at the Command Post.
struct Trial {
  int failures = 0;  // in all
  int strikes = 0;   // failures of this message alone: others were accepted since its previous failure
  int proofs = 0;    // strikes by answers that may reject a message
  std::optional<Instant> failed{};  // the last time
  Instant rests_until{};            // other messages go first until then
  bool steps_behind = false;        // one other message goes first

  bool is_resting(Instant now) const { return steps_behind || now < rests_until; }
};

/// Decides whether a message of one URI fails by its own fault, or because the Command Post fails for all.
/// - If all messages fail, there is an outage, and all of them stay queued.
/// - If a message fails repeatedly while others are accepted, the message is at fault. After each such
///   failure (a strike) one other message goes first, and the message rests twice as long as before, up to
///   kLongestRest. After kMostStrikes by answers that may reject it, it is rejected.
/// - A failure is no strike if another sender's messages were accepted and then failed since the last one:
///   the Command Post is unreliable, and may still accept the message.
class Blame {
 public:
  static constexpr int kMostStrikes = 3;
  static constexpr std::chrono::seconds kFirstRest{2};  // after the first strike; it doubles with each strike
  static constexpr std::chrono::seconds kLongestRest{60};
  static constexpr std::size_t kMostSenders = 1000;

  enum class Decision { Retry, Reject };

  /// A message of `whose` (for example a robot's grids) was accepted.
  void on_passed(const std::string& whose, Instant now);
  /// A message of `whose` failed. Updates `trial`, the failures of that message. `may_reject`: the answer was
  /// about the message rather than about the sender, the token or the server.
  Decision on_failed(const std::string& whose, Trial& trial, Instant now, bool may_reject = true);

 private:
  struct Sender {
    bool passes = false;             // its last message was accepted
    std::optional<Instant> wavered;  // when a message failed after another one was accepted
  };
  bool has_other_wavered(const std::string& but, Instant since) const;
  Sender& sender(const std::string& whose);

  std::map<std::string, Sender> senders_;
  std::optional<Instant> last_passed_;
};

}  // namespace adit::queues
