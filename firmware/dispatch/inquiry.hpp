#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "dispatch/evidence.hpp"

namespace adit::dispatch {

struct Patience {
  /// From the loss to a request whose status may say "not recorded". The Command Post may record a report so
  /// late.
  std::chrono::milliseconds doubt_for{10000};
  std::int64_t asks = 3;  // successive statuses that must say "not recorded"
};

/// Decides from repeated statuses whether the reports in doubt were recorded.
class Inquiry {
 public:
  using Instant = std::chrono::steady_clock::time_point;
  static constexpr std::int64_t kRecordedAsks = 2;  // successive statuses that must say "recorded"

  Inquiry(const Patience& patience, Instant lost) : patience_(patience), lost_(lost) {}

  /// Adds the evidence of a status that was requested at `asked`. Returns the certain result, else Silent.
  Finding hear(const Evidence& evidence, double run_clock, Instant asked, Instant now);
  void asked(Instant now) { asked_ = now; }
  void failed(Instant now) { in_vain_ = !is_pending(now); }
  /// No result for too long. Adit goes on asking, and the operator may decide.
  bool is_in_vain() const { return in_vain_; }

  Instant next_ask(Instant now) const;
  /// Other reports must wait. A second lost report would make the counts ambiguous.
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
