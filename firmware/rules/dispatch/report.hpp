#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "dispatch/report_life.hpp"
#include "icd/artifact_report.hpp"
#include "icd/run_status.hpp"

namespace adit::dispatch {

using Instant = std::chrono::steady_clock::time_point;

struct Time {
  Instant now;
  double stamp = 0;  // seconds since 1970
};

/// A step of the stamp clock at a boot. The clock may step by more than the time for which the machine was
/// off.
struct ClockStep {
  double to = 0;  // stamps from here on are later by `by`; seconds since 1970
  double by = 0;  // seconds

  /// The seconds that passed between two stamps, without the step.
  double between(double from, double until) const {
    return until - from - (from < to && to <= until ? by : 0);
  }
  friend bool operator==(const ClockStep&, const ClockStep&) = default;
};

/// What the ledger holds of an artifact report.
struct Report {
  std::int64_t number = 0;  // assigned by Adit from 1, never reused
  icd::ArtifactReport report = {};
  std::string sender = "";  // the client's address, "operator", or kLost
  double received = 0;      // seconds since 1970
  double changed = 0;
  ReportState state = ReportState::Queued;
  std::string note = "";  // the reason for its state, for the operator

  std::int64_t run = 0;      // Run::number of its run
  bool asked = false;        // sent on purpose: no comparison holds it
  std::int64_t same_as = 0;  // earlier report that it repeats, later one that corrects it, or 0
  std::int64_t tries = 0;    // sendings without an answer
  std::int64_t sending = 0;  // place of the last sending among all; 0: never sent
  double sent = 0;           // last sending; seconds since 1970
  /// The status expected just before it was sent. nullopt: uncertain.
  std::optional<icd::RunStatus> before = std::nullopt;
  /// Earlier reports in doubt that may explain a change of the counts since `before`, one report and up to
  /// one point each.
  std::int64_t beside = 0;
  bool counted = false;  // in doubt: later statuses have its effect, so that it explains no later change
  std::string uncertain = "";  // if in doubt: why the counts do not show what became of it; "": not known

  int status = 0;                 // of the answer; 0: unanswered
  std::string content_type = "";  // of the answer
  std::string answer = "";        // the body, byte for byte
  bool reconciled = false;        // Adit made the answer

  /// A stand-in for reports that damage removed from the ledger, listed in its note. They may have been sent.
  bool is_lost() const { return sender == kLost; }
  static constexpr std::string_view kLost = "lost";
  /// Repeats get the answer of the report `same_as`.
  bool is_corrected() const { return state == ReportState::Withdrawn && same_as > number; }
  friend bool operator==(const Report&, const Report&) = default;
};

}  // namespace adit::dispatch
