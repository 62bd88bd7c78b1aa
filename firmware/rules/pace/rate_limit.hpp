#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <span>

namespace adit::pace {

/// The pause before the next try. It doubles from `first` to `most` with each failure. Each pause is up to a
/// quarter longer by chance, so that many clients do not retry at the same time.
class Backoff {
 public:
  Backoff(std::chrono::milliseconds first, std::chrono::milliseconds most)
      : first_(first), most_(most), wait_(first) {}

  /// Returns the pause. `random`: uniform in [0, 1).
  std::chrono::nanoseconds on_failed(double random);
  void on_succeeded() { wait_ = first_; }

 private:
  std::chrono::milliseconds first_, most_, wait_;
};

using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// The times at which a request's first and last byte left or may leave.
struct Span {
  Instant first{}, last{};
  friend bool operator==(const Span&, const Span&) = default;
};

/// The state of a RateLimit that survives a process restart.
struct LearnedRate {
  Span earliest{};            // times of the next request
  Duration spacing{};         // as learned; 0: as the settings allow
  bool under_way = false;     // a request is in flight, and its outcome is not known here
  bool from_answers = false;  // spacing counts from the server's answer
  int single = 0;             // how often a single 429 caused that
  friend bool operator==(const LearnedRate&, const LearnedRate&) = default;
};

/// Limits requests to one URI to `hertz` per second, evenly spaced. A server may count a request when it
/// begins to arrive or when it is whole, so both the first bytes and the last bytes of two requests are at
/// least the spacing apart. A fiftieth is added because networks do not keep time to the millisecond. After a
/// 429 the spacing counts from the answer, because some servers count so.
///
/// A storm is a series of 429s (RFC 6585 4). The pause between tries doubles up to kStormPause, so that the
/// end of a storm is found within that time. The first accepted request restores the earlier rate, because a
/// storm does not show the rate, however long it lasts. The rate is lowered if a 429 comes at once after a
/// storm, or within kSoonAgain of a short storm or of the second storm in a row. It rises again in steps.
/// Each step that fails doubles the time until the next one (kFirstHold to kLongestHold). The last step
/// counts from the departure again. Adit stops trying it when two storms of a single 429 have led to counting
/// from the answer, because a server that takes its time stamp after decoding always counts so.
class RateLimit {
 public:
  static constexpr double kSlowest = 1.0 / 30;              // hertz
  static constexpr std::chrono::seconds kLongestPause{30};  // the longest Retry-After that is obeyed
  static constexpr std::chrono::seconds kStormPause{4};
  static constexpr std::chrono::seconds kShort{6};  // a shorter storm comes from a limit
  static constexpr std::chrono::seconds kSoonAgain{45};
  static constexpr std::chrono::seconds kFirstHold{10}, kLongestHold{160};

  /// `hertz` > 0.
  explicit RateLimit(double hertz);

  /// The earliest times for the next request. The caller may have to hold back its last byte.
  Span earliest() const;
  /// The earliest time for a request that leaves at once as a whole.
  Instant next() const;
  /// As allowed or learned. A request that leaves within this time does not delay the next.
  Duration spacing() const;
  bool ready(Instant now) const { return now >= next(); }

  /// True if the next request may be sent before the last answer. False in a storm and at a learned rate.
  bool can_pipeline() const { return !storm_ && !rule_.from_answers && rule_.spacing == allowed_; }

  /// `ahead`: the previous request is still in flight. One call of on_answered(), on_not_sent(), on_lost() or
  /// on_throttled() must follow for each request.
  void on_sent(Instant now, bool ahead = false);
  /// The last request has left as `sent` says and is still in flight.
  void on_departed(const Span& sent);
  /// The server accepted or rejected (not with 429) a request at `now`. `sent`: when its bytes left.
  void on_answered(const Span& sent, Instant now);
  /// No byte of the request left.
  void on_not_sent() { end_request(); }
  /// The request failed in doubt. Spacing counts from now, because the connection may have been slow and the
  /// server may have received the request just now.
  void on_lost(Instant now);
  /// The server answered 429. `retry_after` is obeyed up to kLongestPause, because a run lasts half an hour.
  void on_throttled(Instant now, std::optional<std::chrono::seconds> retry_after);

  /// Reserves a turn for a request to the same server on a connection that this limit does not manage.
  /// Returns the time at which it may leave; the spacing to the next request counts from there. Returns
  /// nullopt and reserves no turn if that time is after `latest`.
  std::optional<Instant> claim(Instant now, Instant latest);
  /// Call when the claimed request leaves, perhaps late, and when it ends. Its answer changes no rate.
  void on_claimed(Instant now);

  /// Sets the allowed rate, also since the last request. A learned rate and a pause by a server stay.
  void allow(double hertz, Instant now);

  LearnedRate learned_rate() const;
  /// Restores the previous process's state at `now`. A request in flight may have just ended.
  void restore(const LearnedRate& learned, Instant now);

 private:
  /// A series of 429s.
  struct Storm {
    Instant began;
    Duration pause;
    int sent_before = 0;       // requests in flight when it began; their answers do not end it
    bool counts_anew = false;  // from_answers was set when it began
    bool is_one = true;        // it is a single 429
    Duration worked{0};        // the pause before the last request; if it has ended: of the one that ended it
    Instant ended{};
    Duration on_average{0};  // time per accepted request, from the end of the storm before to its own end
  };

  /// The distance between two requests.
  struct Rule {
    Duration spacing;
    bool from_answers = false;
  };

  bool end_request();
  void count(const Span& sent);
  void begin_storm(Instant now);
  bool is_a_limit() const;
  void slow_down(Instant now);
  void speed_up(Instant now);

  Duration allowed_;                 // the least spacing that the settings allow
  Rule rule_;                        // learned
  Span floor_{};                     // asked for by a server, or restored
  std::optional<Span> counted_;      // the spacing counts from here
  std::optional<Storm> storm_;       // the present one
  std::optional<Storm> last_storm_;  // the last that ended
  std::optional<Instant> sent_;      // the last time
  int under_way_ = 0;
  int taken_since_ = 0;             // requests accepted since the last storm
  int soon_again_ = 0;              // successive storms, each of which began soon after the previous one
  Instant learned_at_{};            // when rule_ changed last
  std::optional<Rule> tried_from_;  // the rule before the step that is on trial
  Duration hold_ = kFirstHold;      // time until the next step
  int single_ = 0;                  // storms of one 429 that led to from_answers
};

/// One of several message kinds on a connection.
struct Candidate {
  std::optional<Instant> oldest;  // when its oldest message was accepted; nullopt: no message
  Instant ready;                  // end of its rate limit or back-off
};

struct Turn {
  std::optional<std::size_t> candidate;  // its index
  std::optional<Instant> wake;           // without a candidate: when to ask again; nullopt: no messages
};

/// Chooses the oldest message among the candidates that are ready.
Turn oldest_first(std::span<const Candidate> candidates, Instant now);

/// The first candidate with a message. The others wait for it, even if it is not ready.
Turn first_ready(std::span<const Candidate> candidates, Instant now);

}  // namespace adit::pace
