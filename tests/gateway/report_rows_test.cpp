#include "gateway/report_rows.hpp"

#include <gmock/gmock.h>

namespace adit::gateway {
namespace {

using dispatch::ReportState;
using testing::ElementsAre;

std::map<std::int64_t, dispatch::Report> reports(const std::vector<ReportState>& states) {
  std::map<std::int64_t, dispatch::Report> all;
  for (const ReportState state : states) {
    const auto number = static_cast<std::int64_t>(all.size()) + 1;
    all[number].number = number;
    all[number].state = state;
  }
  return all;
}

std::vector<std::int64_t> latest(const std::map<std::int64_t, dispatch::Report>& all, std::size_t most) {
  std::vector<std::int64_t> numbers;
  for (const dispatch::Report* const report : latest_of(all, most)) numbers.push_back(report->number);
  return numbers;
}

TEST(LatestReports, AreTheNewestAndNewestFirst) {
  const auto all = reports({ReportState::Answered, ReportState::Refused, ReportState::Withdrawn});
  EXPECT_THAT(latest(all, 5), ElementsAre(3, 2, 1));
  EXPECT_THAT(latest(all, 2), ElementsAre(3, 2));
  EXPECT_THAT(latest({}, 2), ElementsAre());
}

TEST(LatestReports, HaveEachThatWaitsForSomething_HoweverOldItIs) {
  const auto all = reports({ReportState::InDoubt, ReportState::Answered, ReportState::Received,
                            ReportState::Answered, ReportState::Answered});
  EXPECT_THAT(latest(all, 3), ElementsAre(5, 3, 1));
  EXPECT_THAT(latest(all, 2), ElementsAre(3, 1));
  EXPECT_THAT(latest(all, 1), ElementsAre(3));
}

}  // namespace
}  // namespace adit::gateway
