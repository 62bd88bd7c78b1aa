#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "dispatch/evidence.hpp"

namespace adit::dispatch {

/// How patiently Adit finds out what became of a report whose answer was lost.
struct Patience {
  /// How late a Command Post may still record what it has read: a report counts as not recorded only if a
  /// status that was asked for this long after its answer was lost says so.
  std::chrono::milliseconds doubt_for{10000};
  std::int64_t asks = 3;  // statuses in a row that must say "not recorded"
};

/// The run's status, asked for again and again after reports came into doubt, until it is clear what became
/// of them.
class Inquiry {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::int64_t kRecordedAsks = 2;  // statuses in a row that must say "recorded"

  Inquiry(const Patience& patience, Instant lost) : patience_(patience), lost_(lost) {}

  /// Weighs one status, which may be as old as the moment at which it was asked for. Gives what is now
  /// certain: Recorded, NotRecorded, Contradicts, or Silent (nothing yet).
  Finding hear(const Evidence& evidence, double run_clock, Instant asked, Instant now);
  void asked(Instant now) { asked_ = now; }
  /// No status came.
  void failed(Instant now) { in_vain_ = !is_pending(now); }
  /// Nothing became certain for long enough: the inquiry goes on, but the operator may decide as well.
  bool is_in_vain() const { return in_vain_; }

  Instant next_ask(Instant now) const;
  /// Whether other reports should still wait for the outcome: another one that is sent and lost would blur
  /// it.
  bool is_pending(Instant now) const;

 private:
  bool stands_still(double run_clock, Instant now) const;

  Patience patience_;
  Instant lost_;
  std::optional<Instant> asked_;
  Finding finding_ = Finding::Silent;
  std::int64_t agreeing_ = 0;
  std::optional<Instant> first_heard_, last_heard_;
  double first_clock_ = 0;
  bool in_vain_ = false;
};

}  // namespace adit::dispatch
