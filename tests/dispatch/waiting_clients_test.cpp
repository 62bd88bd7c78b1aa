#include <gmock/gmock.h>

#include "dispatch/run_changes.hpp"
#include "dispatch/scene.hpp"

namespace adit::dispatch {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

Instant at_second(int s) {
  return Instant{} + std::chrono::seconds(s);
}

class WaitingClientsTest : public testing::Test {
 protected:
  WaitingClientsTest() {
    book_.open({{.number = 7, .state = ReportState::Sending}, {.number = 8}, {.number = 9}});
    clients_.add(1, 7, at_second(20));
    clients_.add(2, 8, at_second(21));
    clients_.add(3, 7, at_second(22));
  }
  /// Answers since the last call: client and report.
  std::vector<std::pair<ClientId, std::int64_t>> told() {
    std::vector<std::pair<ClientId, std::int64_t>> all;
    for (const auto& [client, answers] : std::exchange(output_.answers, {})) {
      for (const auto& answer : answers) all.emplace_back(client, answer.number);
    }
    return all;
  }
  FakeOutput output_;
  ReportBook book_{output_};
  RunAccount account_{book_};
  WaitingClients clients_{book_, account_, output_};
};

TEST_F(WaitingClientsTest, HaveAReportEach) {
  EXPECT_EQ(clients_.awaited_report(2), 8);
  EXPECT_EQ(clients_.awaited_report(4), std::nullopt);
}

TEST_F(WaitingClientsTest, AreAnsweredOnce) {
  clients_.answer_all(7);
  EXPECT_THAT(told(), ElementsAre(Pair(1, 7), Pair(3, 7)));
  clients_.answer_all(7);
  clients_.answer_all(9);
  EXPECT_THAT(told(), IsEmpty());
}

TEST_F(WaitingClientsTest, AreAnsweredAtTheirDeadline) {
  EXPECT_EQ(clients_.next_deadline(), at_second(20));
  clients_.tick(at_second(19));
  EXPECT_THAT(told(), IsEmpty());
  clients_.tick(at_second(21));
  EXPECT_THAT(told(), ElementsAre(Pair(1, 7), Pair(2, 8)));
  EXPECT_EQ(clients_.next_deadline(), at_second(22));
}

TEST_F(WaitingClientsTest, MayHaveAnEarlierDeadlineThanOthers) {
  clients_.add(4, 9, at_second(5));
  EXPECT_EQ(clients_.next_deadline(), at_second(5));
}

TEST_F(WaitingClientsTest, AreDismissedExceptThoseOfAReportInFlight) {
  clients_.dismiss(false);
  EXPECT_THAT(told(), ElementsAre(Pair(2, 8)));
  clients_.dismiss(true);
  EXPECT_THAT(told(), ElementsAre(Pair(1, 7), Pair(3, 7)));
  EXPECT_EQ(clients_.next_deadline(), std::nullopt);
}

TEST_F(WaitingClientsTest, KeepTheirDeadlineAtAHandOver) {
  clients_.hand_over(7, book_.at(8));
  EXPECT_EQ(clients_.next_deadline(), at_second(20));
  clients_.answer_all(7);
  EXPECT_THAT(told(), IsEmpty());
  clients_.answer_all(8);
  EXPECT_THAT(told(), ElementsAre(Pair(1, 8), Pair(2, 8), Pair(3, 8)));
}

TEST_F(WaitingClientsTest, HandOverTheTimeOfTheLastPost) {
  clients_.on_posted(8, at_second(5));
  clients_.on_posted(9, at_second(1));
  clients_.hand_over(8, book_.at(9));
  EXPECT_TRUE(clients_.is_young(book_.at(9), at_second(14)));
  EXPECT_FALSE(clients_.is_young(book_.at(9), at_second(15)));
}

}  // namespace
}  // namespace adit::dispatch
