#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

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

constexpr std::string_view shown_name_of(ReportState state) {
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

/// nullopt for an unknown word.
std::optional<ReportState> state_named(std::string_view name);

}  // namespace adit::dispatch
