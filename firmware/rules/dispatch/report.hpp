#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "icd/scoring.hpp"

namespace adit::dispatch {

/// States of an artifact report (promise 1).
enum class ReportState : std::uint8_t {
  Held,  // waits for the operator, or until the present run is known
  Queued,
  Sending,    // its bytes are about to leave
  Answered,   // the Command Post has recorded it and answered
  Rejected,   // the Command Post has rejected it, and a retry would not help
  InDoubt,    // its bytes may have left, and the answer is not known; evidence or the operator moves it on
  Settled,    // finished without the Command Post's answer, by evidence or by the operator
  Withdrawn,  // the operator withdrew it, or it repeats an earlier report
};
/// In the order of ReportState: words of the API, the metrics and `adit`.
inline constexpr std::string_view kStateWords[] = {"held",     "queued",   "sending", "answered",
                                                   "rejected", "in_doubt", "settled", "withdrawn"};
constexpr std::string_view name_of(ReportState state) {
  return kStateWords[static_cast<std::size_t>(state)];
}

constexpr std::string_view display_name(ReportState state) {
  return state == ReportState::InDoubt ? "in doubt" : name_of(state);
}

enum class ReportEvent : std::uint8_t {
  Held,      // by the review, a new run, or too many losses
  HeldBack,  // by the operator
  Released,  // the operator sends it
  Chosen,
  Recorded,    // answered 2xx
  Rejected,    // another 4xx
  Throttled,   // 429
  Barred,      // 401, 403, 404, 405 or 407: wrong token or address
  Redirected,  // 307 or 308 to the other form of the path: not processed
  NeverLeft,   // the kernel has no byte of it
  Lost,        // bytes may have left, no usable answer
  Found,       // recorded, by the run's status
  Missing,     // not recorded, by the run's status
  Settled,     // declared done by the operator
  Withdrawn,   // by the operator
  Corrected,   // the operator sends another report in its place
  Joined,      // it repeats an earlier report and gets that report's answer
  Cleared,     // held as a possible repeat, and is not one
  UndoOver,    // the time for an undo is over
  Restarted,
};

/// The effect of a step once it is on disk.
enum class ReportAction : std::uint8_t {
  Nothing,
  Send,
  AnswerClients,  // give the stored answer to its clients
  TellClients,    // with the new state
  Ask,            // for the run's status
};

struct ReportTransition {
  ReportState from;
  ReportEvent event;
  ReportState to;
  ReportAction action;
};

/// All transitions. An event without a row is impossible in that state.
std::span<const ReportTransition> report_life();
/// Null if there is no row.
const ReportTransition* transition(ReportState state, ReportEvent event);

/// True if Adit does no more with a report in this state.
bool is_final(ReportState state);

std::optional<ReportState> state_named(std::string_view name);

using Instant = std::chrono::steady_clock::time_point;

struct Time {
  Instant now;
  double stamp = 0;  // seconds since 1970
};

/// A step of the stamp clock at a boot. It may exceed the time for which the machine was off.
struct ClockStep {
  double to = 0;  // stamps from here on are later by `by`; seconds since 1970
  double by = 0;  // seconds

  /// The seconds that passed between two stamps, without the step.
  double seconds_between(double from, double until) const {
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
  /// Earlier doubts that may explain a change of counts since `before`: one report, up to one point each.
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

/// Metres per axis: below a robot's accuracy, above the rounding of float32.
inline constexpr double kSamePlace = 1e-3;

/// Same type in any letter case (ICD 5.2) and same place.
bool is_same(const icd::ArtifactReport& one, const icd::ArtifactReport& other);

/// Same type, at most `metres` apart.
bool is_near(const icd::ArtifactReport& one, const icd::ArtifactReport& other, double metres);

/// In metres.
double distance(const icd::ArtifactReport& one, const icd::ArtifactReport& other);

/// A quoted type and a place, to the millimetre: "Drill" at 1, 2.5, 3
std::string describe(const icd::ArtifactReport& report);

}  // namespace adit::dispatch
