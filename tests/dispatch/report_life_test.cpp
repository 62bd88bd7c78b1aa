#include <gmock/gmock.h>

#include <array>
#include <set>
#include <string>
#include <string_view>

#include "dispatch/report.hpp"
#include "project_files.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using Event = ReportEvent;

constexpr std::array kStates = {Held, Queued, Sending, Answered, Rejected, InDoubt, Settled, Withdrawn};
static_assert(kStates.size() == std::size(kStateWords));

std::set<Event> events_between(ReportState from, ReportState to) {
  std::set<Event> events;
  for (const ReportTransition& row : report_life()) {
    if (row.from == from && row.to == to) events.insert(row.event);
  }
  return events;
}

TEST(ReportLife, SendsOnlyQueuedReports) {
  for (const ReportState state : kStates) {
    EXPECT_EQ(transition(state, Event::Chosen) != nullptr, state == Queued) << name_of(state);
  }
}

TEST(ReportLife, QueuesASentReportOnlyIfItIsNotRecorded) {
  EXPECT_EQ(events_between(Sending, Queued),
            (std::set{Event::Throttled, Event::Barred, Event::Redirected, Event::NeverLeft}));
}

TEST(ReportLife, EndsADoubtByEvidenceOrTheOperator) {
  std::set<Event> out;
  for (const ReportTransition& row : report_life()) {
    if (row.from == InDoubt && row.to != InDoubt) out.insert(row.event);
  }
  EXPECT_EQ(out, (std::set{Event::Found, Event::Missing, Event::Held, Event::Released, Event::Settled}));
}

TEST(ReportLife, PutsASendingReportInDoubtAtARestart) {
  EXPECT_EQ(transition(Sending, Event::Restarted)->to, InDoubt);
}

TEST(ReportLife, KeepsEachOtherStateAtARestart) {
  for (const ReportState state : kStates) {
    if (state == Sending) continue;
    const ReportTransition* const row = transition(state, Event::Restarted);
    ASSERT_NE(row, nullptr) << name_of(state);
    EXPECT_EQ(row->to, state);
  }
}

TEST(ReportLife, AnswersClientsOnlyIfAnAnswerIsKnown) {
  for (const ReportTransition& row : report_life()) {
    if (row.action != ReportAction::AnswerClients) continue;
    EXPECT_TRUE(row.to == Answered || row.to == Rejected || row.to == Settled) << name_of(row.to);
  }
}

TEST(ReportLife, HasEachEventOncePerState) {
  std::set<std::pair<ReportState, Event>> seen;
  for (const ReportTransition& row : report_life()) EXPECT_TRUE(seen.emplace(row.from, row.event).second);
}

TEST(ReportLife, FindsEachStateByItsName) {
  for (const ReportState state : kStates) EXPECT_EQ(state_named(name_of(state)), state);
  EXPECT_EQ(state_named("elsewhere"), std::nullopt);
}

/// Name of the event in the diagram.
std::string_view words(ReportEvent event) {
  switch (event) {
    case Event::Held:
      return "held for the operator";
    case Event::HeldBack:
      return "operator: hold";
    case Event::Released:
      return "operator: send";
    case Event::Chosen:
      return "its turn";
    case Event::Recorded:
      return "2xx";
    case Event::Rejected:
      return "4xx";
    case Event::Throttled:
      return "429";
    case Event::Barred:
      return "401, 403, 404, 405, 407";
    case Event::Redirected:
      return "307, 308 to the same path with or without a slash";
    case Event::NeverLeft:
      return "no byte left";
    case Event::Lost:
      return "no answer, 3xx, 408, 5xx";
    case Event::Found:
      return "status: recorded";
    case Event::Missing:
      return "status: not recorded";
    case Event::Settled:
      return "operator: done";
    case Event::Withdrawn:
      return "operator: withdraw";
    case Event::Corrected:
      return "operator: correct";
    case Event::Joined:
      return "same as an earlier one";
    case Event::Cleared:
      return "the run is certain";
    case Event::UndoOver:
      return "its time for an undo is over";
    case Event::Restarted:
      return "restart";
  }
  return "";
}

std::string_view words(ReportAction action) {
  switch (action) {
    case ReportAction::Nothing:
      return "";
    case ReportAction::Send:
      return " / send";
    case ReportAction::AnswerClients:
      return " / answer its clients";
    case ReportAction::TellClients:
      return " / tell its clients";
    case ReportAction::Ask:
      return " / ask the status";
  }
  return "";
}

std::string diagram() {
  std::string text = "stateDiagram-v2\n  state \"in doubt\" as in_doubt\n  [*] --> queued: posted\n";
  const auto id = [](ReportState state) { return name_of(state); };
  for (const ReportTransition& row : report_life()) {
    if (row.from == row.to) continue;
    text.append("  ").append(id(row.from)).append(" --> ").append(id(row.to)).append(": ");
    text.append(words(row.event)).append(words(row.action)).append("\n");
  }
  for (const std::string_view word : kStateWords) {
    const auto state = state_named(word);
    if (is_final(*state)) text.append("  ").append(id(*state)).append(" --> [*]\n");
  }
  return text;
}

TEST(ReportLife, MatchesTheDiagramOfTheReadme) {
  EXPECT_THAT(project_text("firmware/rules/dispatch/README.md"),
              testing::HasSubstr("```mermaid\n" + diagram() + "```\n"));
}

}  // namespace
}  // namespace adit::dispatch
