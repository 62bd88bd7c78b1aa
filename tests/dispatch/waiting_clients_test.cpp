#include "dispatch/waiting_clients.hpp"

#include <gmock/gmock.h>

namespace adit::dispatch {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

WaitingClients::Instant at_second(int s) {
  return WaitingClients::Instant{} + std::chrono::seconds(s);
}

class WaitingClientsTest : public testing::Test {
 protected:
  WaitingClientsTest() {
    clients_.add(1, 7, at_second(20));
    clients_.add(2, 8, at_second(21));
    clients_.add(3, 7, at_second(22));
  }
  WaitingClients clients_;
};

TEST_F(WaitingClientsTest, KnowWhichReportEachOfThemWaitsFor) {
  EXPECT_EQ(clients_.awaited_by(2), 8);
  EXPECT_EQ(clients_.awaited_by(4), std::nullopt);
}

TEST_F(WaitingClientsTest, AreTakenOnceByTheirReport) {
  EXPECT_THAT(clients_.take(7), ElementsAre(1, 3));
  EXPECT_THAT(clients_.take(7), IsEmpty());
  EXPECT_THAT(clients_.take(9), IsEmpty());
}

TEST_F(WaitingClientsTest, AreTakenOnceTheirTimeIsUp) {
  EXPECT_EQ(clients_.next_deadline(), at_second(20));
  EXPECT_THAT(clients_.take_late(at_second(19)), IsEmpty());
  EXPECT_THAT(clients_.take_late(at_second(21)), ElementsAre(Pair(1, 7), Pair(2, 8)));
  EXPECT_EQ(clients_.next_deadline(), at_second(22));
}

TEST_F(WaitingClientsTest, MayWaitLessLongThanEarlierOnes) {
  clients_.add(4, 9, at_second(5));
  EXPECT_EQ(clients_.next_deadline(), at_second(5));
}

TEST_F(WaitingClientsTest, AreTakenButForThoseOfOneReport) {
  EXPECT_THAT(clients_.take_but(7), ElementsAre(Pair(2, 8)));
  EXPECT_THAT(clients_.take_but(std::nullopt), ElementsAre(Pair(1, 7), Pair(3, 7)));
  EXPECT_EQ(clients_.next_deadline(), std::nullopt);
}

TEST_F(WaitingClientsTest, KeepTheirTimeWhereTheyAreHandedOverToAnotherReport) {
  clients_.hand_over(7, 8);
  EXPECT_EQ(clients_.next_deadline(), at_second(20));
  EXPECT_THAT(clients_.take(7), IsEmpty());
  EXPECT_THAT(clients_.take(8), ElementsAre(1, 2, 3));
}

}  // namespace
}  // namespace adit::dispatch
