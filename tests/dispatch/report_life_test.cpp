#include "dispatch/report_life.hpp"

#include <gmock/gmock.h>

#include <array>
#include <fstream>
#include <set>
#include <sstream>

namespace adit::dispatch {
namespace {

using enum ReportState;
using Event = ReportEvent;

constexpr std::array kStates = {Received, Waiting, Sending, Answered, Refused, InDoubt, Settled, Withdrawn};

std::set<Event> events_between(ReportState from, ReportState to) {
  std::set<Event> events;
  for (const ReportTransition& row : report_life()) {
    if (row.from == from && row.to == to) events.insert(row.event);
  }
  return events;
}

TEST(ReportLife, IsSentOnlyFromWaiting) {
  for (const ReportState state : kStates) {
    EXPECT_EQ(transition(state, Event::Chosen) != nullptr, state == Waiting) << name_of(state);
  }
}

TEST(ReportLife, IsSentAgainByItselfOnlyWhereTheCommandPostCannotHaveRecordedIt) {
  EXPECT_EQ(events_between(Sending, Waiting), (std::set{Event::Throttled, Event::Barred, Event::NeverLeft}));
}

TEST(ReportLife, LeavesDoubtOnlyByEvidenceOrTheOperator) {
  std::set<Event> out;
  for (const ReportTransition& row : report_life()) {
    if (row.from == InDoubt && row.to != InDoubt) out.insert(row.event);
  }
  EXPECT_EQ(out, (std::set{Event::Found, Event::Missing, Event::Held, Event::Released, Event::CalledDone}));
}

TEST(ReportLife, IsInDoubtAfterACrashWhileSending) {
  EXPECT_EQ(transition(Sending, Event::Restarted)->to, InDoubt);
}

TEST(ReportLife, IsAsWeLeftItAfterACrashInAnyOtherState) {
  for (const ReportState state : kStates) {
    if (state == Sending) continue;
    const ReportTransition* const row = transition(state, Event::Restarted);
    ASSERT_NE(row, nullptr) << name_of(state);
    EXPECT_EQ(row->to, state);
  }
}

TEST(ReportLife, AnswersAClientOnlyWhereAnAnswerIsKnown) {
  for (const ReportTransition& row : report_life()) {
    if (row.action != ReportAction::AnswerClients) continue;
    EXPECT_TRUE(row.to == Answered || row.to == Refused || row.to == Settled) << name_of(row.to);
  }
}

TEST(ReportLife, NamesEachEventOnceForAState) {
  std::set<std::pair<ReportState, Event>> seen;
  for (const ReportTransition& row : report_life()) EXPECT_TRUE(seen.emplace(row.from, row.event).second);
}

TEST(ReportLife, NamesEachStateOnceAndFindsItByItsName) {
  for (const ReportState state : kStates) EXPECT_EQ(state_named(name_of(state)), state);
  EXPECT_EQ(state_named("elsewhere"), std::nullopt);
}

TEST(ReportLife, IsDrawnInTheDocsAsItIs) {
  std::ifstream file(ADIT_SOURCE_DIR "/firmware/dispatch/README.md");
  std::stringstream text;
  text << file.rdbuf();
  EXPECT_THAT(text.str(), testing::HasSubstr("```mermaid\n" + report_life_diagram() + "```\n"));
}

}  // namespace
}  // namespace adit::dispatch
