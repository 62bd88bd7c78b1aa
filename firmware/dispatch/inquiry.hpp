#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "dispatch/evidence.hpp"

namespace adit::dispatch {

/// How patiently Adit finds out what became of a report whose answer was lost.
struct Patience {
  /// How late a Command Post may still record what it has read: a report counts as not recorded only where a
  /// status says so that was asked for this long after its answer was lost.
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

  /// One status, weighed; it may be of the moment at which it was asked for. Gives what is now certain:
  /// Recorded, NotRecorded, Contradicts, or Silent.
  Finding hear(const Evidence& evidence, double run_clock, Instant asked, Instant now);
  void asked(Instant now) { asked_ = now; }
  /// An asking that brought no status.
  void failed(Instant now) { in_vain_ = !is_pending(now); }
  /// It has been asked for long enough, and nothing became certain: it goes on, but the operator may as well
  /// decide.
  bool is_in_vain() const { return in_vain_; }

  Instant next_ask(Instant now) const;
  /// Whether other reports should still wait for the outcome: one that is sent meanwhile, and lost too, would
  /// blur it.
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
