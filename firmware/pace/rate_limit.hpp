#pragma once

#include <chrono>
#include <optional>

namespace adit::pace {

using Instant = std::chrono::steady_clock::time_point;
using Duration = std::chrono::nanoseconds;

/// Of one request: its first byte and its last, when they left or may leave.
struct Span {
  Instant first{}, last{};
  friend bool operator==(const Span&, const Span&) = default;
};

/// What of a rate limit outlives its gateway.
struct Learned {
  Span earliest{};            // of the next request
  Duration spacing{};         // learned; 0: as the settings allow
  bool under_way = false;     // a request was sent, and how it ended is not known here
  bool from_answers = false;  // learned: the server counts from its answer to the next request
  int single = 0;             // how often a 429 and nothing else has taught that
  friend bool operator==(const Learned&, const Learned&) = default;
};

/// How often one URI may be asked: at most `hertz` times a second, evenly spaced. A server may count a
/// request when it begins to come or when it is there, so that the first bytes of two requests are the
/// spacing apart, and so are their last bytes, by a fiftieth more: networks do not keep time to the
/// millisecond. After a 429 the spacing counts from the answer to the first byte of the next request, for a
/// server that counts so.
///
/// After a 429 (RFC 6585 4) it tries again with pauses that double up to kStormPause, so that the end of a
/// storm is found within that time, and the first request that is taken brings back the rate from before: a
/// storm says nothing about the rate, however long it lasts. What lasts is a limit, and is learned: the rate
/// goes down where a 429 comes again at once, or within kSoonAgain of a short storm or of the second in a
/// row; and up again by steps, of which each that fails doubles the time until the next (kFirstHold to
/// kLongestHold). The last step is to count from the answer no more, until a single 429 has followed that: a
/// server that takes its time stamp after decoding does so for good.
class RateLimit {
 public:
  static constexpr double kSlowest = 1.0 / 30;              // hertz
  static constexpr std::chrono::seconds kLongestPause{30};  // that a server may ask for
  static constexpr std::chrono::seconds kStormPause{4};
  static constexpr std::chrono::seconds kShort{6};  // no storm: a limit refuses, and then lets one pass
  static constexpr std::chrono::seconds kSoonAgain{45};
  static constexpr std::chrono::seconds kFirstHold{10}, kLongestHold{160};

  /// hertz > 0.
  explicit RateLimit(double hertz);

  /// The earliest times for the next request. Its last byte may have to be held back.
  Span earliest() const;
  /// The earliest time for one that leaves at once, whole.
  Instant next() const;
  /// From one request to the next, as allowed or learned: what one of them may take to leave without being
  /// in the way of the next.
  Duration spacing() const;
  bool ready(Instant now) const { return now >= next(); }

  /// Whether the next request may be sent before the answer to the last one: not while it is learned how
  /// often the server lets itself be asked.
  bool may_go_ahead() const { return !storm_ && !rule_.from_answers && rule_.spacing == allowed_; }

  /// `ahead`: the one before is still to be answered. Of each it is to be said what became of it.
  void sent(Instant now, bool ahead = false);
  /// The request sent last has left as `sent` says, and is still to be answered.
  void left(const Span& sent);
  /// A request was answered at `now`; its bytes had left as `sent` says.
  void taken(const Span& sent, Instant now);
  /// A request did not leave.
  void not_sent() { end_one(); }
  /// No answer of it counts, and it may have been heard: spacing counts from now, for its connection may have
  /// been long in coming.
  void lost(Instant now);
  /// 429; `retry_after` as the server gave it, heeded up to kLongestPause: more is no use in a run of half an
  /// hour.
  void throttled(Instant now, std::optional<std::chrono::seconds> retry_after);

  /// When a request may leave by another connection that is none of this limit's, but goes to the same
  /// server: that turn is then taken, and the next one counts from it. Nothing, and no turn is taken: later
  /// than `latest`.
  std::optional<Instant> claim(Instant now, Instant latest);
  /// It leaves, which may be later than claimed; it ended, answered or not. It teaches nothing.
  void claimed(Instant now);

  /// So often is allowed, also since the last request. What was learned of the server stays, and a pause that
  /// it asked for.
  void allow(double hertz, Instant now);

  Learned learned() const;
  /// What the gateway before has learned; this one begins at `now`. A request that was under way may have
  /// ended just before.
  void carry_on(const Learned& learned, Instant now);

 private:
  /// 429 and nothing else.
  struct Storm {
    Instant began;
    Duration pause;
    int sent_before = 0;       // requests under way when it began: their answers do not end it
    bool counts_anew = false;  // the rule became from_answers when it began
    bool is_one = true;        // it is a single 429
  };

  /// Which requests are far enough apart.
  struct Rule {
    Duration spacing;
    bool from_answers = false;
  };

  bool end_one();
  void count(const Span& sent);
  void begin_storm(Instant now);
  bool is_a_limit() const;
  void slow_down(Instant now);
  void speed_up(Instant now);

  Duration allowed_;             // between two requests, as all that follow
  Rule rule_;                    // learned
  Span floor_{};                 // what a server asked for, or an earlier life
  std::optional<Span> counted_;  // the spacing counts from there
  std::optional<Storm> storm_;
  std::optional<Instant> sent_;  // last
  int under_way_ = 0;
  Duration worked_{0};                 // the pause before the request that ended the last storm
  std::optional<Instant> calm_since_;  // the end of the last storm
  bool last_was_short_ = false;
  int taken_since_ = 0;     // the end of the last storm
  int soon_again_ = 0;      // storms in a row, each of which began soon after the one before
  Duration on_average_{0};  // between two that were taken, from the end of one storm to the end of the next
  Instant learned_at_{};    // when rule_ changed last
  std::optional<Rule> tried_from_;  // the rule before the step up that is on trial
  Duration hold_ = kFirstHold;      // until the next step up
  int single_ = 0;                  // storms of one 429 that ended with counting from the answers
};

}  // namespace adit::pace
