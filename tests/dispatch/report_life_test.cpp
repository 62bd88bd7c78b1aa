#include "dispatch/report_life.hpp"

#include <gtest/gtest.h>

#include <array>

namespace adit::dispatch {
namespace {

constexpr std::array kStates = {ReportState::Waiting, ReportState::Sending, ReportState::Answered,
                                ReportState::Refused, ReportState::InDoubt};
constexpr std::array kEvents = {ReportEvent::Chosen,    ReportEvent::Recorded,  ReportEvent::Refused,
                                ReportEvent::Throttled, ReportEvent::NeverLeft, ReportEvent::Lost,
                                ReportEvent::Restarted};

TEST(ReportLife, IsSentOnlyFromWaiting) {
  for (const ReportState state : kStates) {
    EXPECT_EQ(next(state, ReportEvent::Chosen).has_value(), state == ReportState::Waiting) << name_of(state);
  }
}

TEST(ReportLife, IsSentAgainOnlyWhereTheCommandPostCannotHaveRecordedIt) {
  for (const ReportEvent event : kEvents) {
    const bool again = next(ReportState::Sending, event) == ReportState::Waiting;
    EXPECT_EQ(again, event == ReportEvent::Throttled || event == ReportEvent::NeverLeft) << int(event);
  }
}

TEST(ReportLife, StaysInDoubtWhateverHappensByItself) {
  for (const ReportEvent event : kEvents) {
    EXPECT_EQ(next(ReportState::InDoubt, event).value_or(ReportState::InDoubt), ReportState::InDoubt);
  }
}

TEST(ReportLife, IsInDoubtAfterACrashWhileSending) {
  EXPECT_EQ(next(ReportState::Sending, ReportEvent::Restarted), ReportState::InDoubt);
  EXPECT_EQ(next(ReportState::Waiting, ReportEvent::Restarted), ReportState::Waiting);
}

TEST(ReportLife, KnowsEveryStateAfterARestart) {
  for (const ReportState state : kStates) EXPECT_TRUE(next(state, ReportEvent::Restarted)) << name_of(state);
}

TEST(ReportLife, NamesEachStateOnceAndFindsItByItsName) {
  for (const ReportState state : kStates) EXPECT_EQ(state_named(name_of(state)), state);
  EXPECT_EQ(state_named("elsewhere"), std::nullopt);
}

TEST(ReportLife, ReadsTheCommandPostsStatus) {
  struct Row {
    int status;
    ReportEvent event;
  };
  for (const Row& row :
       {Row{200, ReportEvent::Recorded}, Row{201, ReportEvent::Recorded}, Row{400, ReportEvent::Refused},
        Row{401, ReportEvent::Refused}, Row{422, ReportEvent::Refused}, Row{429, ReportEvent::Throttled},
        Row{500, ReportEvent::Lost}, Row{502, ReportEvent::Lost}, Row{302, ReportEvent::Lost}}) {
    EXPECT_EQ(event_of(row.status), row.event) << row.status;
  }
}

}  // namespace
}  // namespace adit::dispatch
