#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace adit::dispatch {

/// Where an artifact report is in its life (promise 1).
enum class ReportState : std::uint8_t {
  Held,       // on disk, and held: only the operator can release it
  Queued,     // to be sent when its turn comes
  Sending,    // its bytes are about to leave
  Answered,   // the Command Post recorded it and said so
  Rejected,   // the Command Post said that it did not record it, and that sending it again is no use
  InDoubt,    // its bytes may have left and no answer is known; only evidence or the operator moves it on
  Settled,    // no answer came, but it is known, or the operator says, that there is nothing left to do
  Withdrawn,  // the operator took it back before it was sent, or it is a repeat of an earlier one
};
/// In the order of the states: the words of the API, the metrics and `adit`.
inline constexpr std::string_view kStateWords[] = {"held",     "queued",   "sending", "answered",
                                                   "rejected", "in_doubt", "settled", "withdrawn"};
constexpr std::string_view name_of(ReportState state) {
  return kStateWords[static_cast<std::size_t>(state)];
}

/// The same word as people read it: "in doubt".
constexpr std::string_view shown_name_of(ReportState state) {
  return state == ReportState::InDoubt ? "in doubt" : name_of(state);
}

enum class ReportEvent : std::uint8_t {
  Held,       // the review, a new run or too many failures: the operator has to release it
  HeldBack,   // the operator holds it, until he releases it
  Released,   // the operator says that it is to be sent
  Chosen,     // its turn has come
  Recorded,   // answered 2xx
  Rejected,   // answered 4xx: the Command Post will not have it
  Throttled,  // answered 429: not recorded, may be sent again
  Barred,  // answered 401, 403, 404, 405 or 407: nothing is wrong with it, but with the token or the address
  NeverLeft,  // no byte of it was given to the kernel
  Lost,       // bytes may have left, and no answer came that tells anything
  Found,      // the run's status shows that it was recorded
  Missing,    // the run's status shows that it was not recorded
  Settled,    // the operator says that nothing is left to do
  Withdrawn,  // the operator takes it back
  Joined,     // it is the same as an earlier one, whose answer it gets
  Cleared,    // it is no repeat of an earlier run's report; it was held until that was known
  Restarted,  // this program restarted and found it so
};

/// What to do once the step is on disk.
enum class ReportAction : std::uint8_t {
  Nothing,
  Send,           // its bytes go to the Command Post
  AnswerClients,  // clients that wait for it get its answer
  TellClients,    // clients that wait for it are told its state, and that it is kept
  Ask,            // the run's status is asked for, to find out what became of it
};

struct ReportTransition {
  ReportState from;
  ReportEvent event;
  ReportState to;
  ReportAction action;
};

/// The one table of a report's life. An event that is not in it for a state cannot happen there.
std::span<const ReportTransition> report_life();
/// The row for `event` in `state`; nothing where there is none.
const ReportTransition* transition(ReportState state, ReportEvent event);

/// Nothing more will happen to it, and nobody has anything left to do about it.
bool is_final(ReportState state);

/// Nothing where it is none of the words.
std::optional<ReportState> state_named(std::string_view name);

}  // namespace adit::dispatch
