#include "update/health.hpp"

#include <gtest/gtest.h>

namespace adit::update {
namespace {

using namespace std::chrono_literals;

TEST(Health, ReadsHowLongAServiceIsReady) {
  EXPECT_EQ(read_ready("ActiveState=active\nActiveEnterTimestampMonotonic=5000000\n", 7s), Ready(2s));
  EXPECT_EQ(read_ready("ActiveEnterTimestampMonotonic=5000000\nActiveState=active", 5s), Ready(0s));
}

TEST(Health, IsUnknownForAServiceThatIsNotReady) {
  for (const char* said :
       {"", "ActiveState=activating\nActiveEnterTimestampMonotonic=5000000\n",
        "ActiveState=failed\nActiveEnterTimestampMonotonic=5000000\n", "ActiveState=active\n",
        "ActiveState=active\nActiveEnterTimestampMonotonic=\n",
        "ActiveState=active\nActiveEnterTimestampMonotonic=0\n",
        "ActiveState=active\nActiveEnterTimestampMonotonic=12x\n",
        "ActiveState=active\nActiveEnterTimestampMonotonic=-4\n",
        "ActiveState=active\nActiveEnterTimestampMonotonic=9000000\n",
        "NotActiveState=active\nActiveEnterTimestampMonotonic=5000000\n",
        "ActiveState=inactive\nActiveState=active\nActiveEnterTimestampMonotonic=5000000\n"}) {
    EXPECT_EQ(read_ready(said, 7s), std::nullopt) << said;
  }
}

TEST(Health, OfATrialIsGoodAfterAMinute) {
  EXPECT_EQ(classify(true, std::nullopt, false), Health::Wait);
  EXPECT_EQ(classify(true, 0s, false), Health::Wait);
  EXPECT_EQ(classify(true, 59s, false), Health::Wait);
  EXPECT_EQ(classify(true, 60s, false), Health::Good);
}

TEST(Health, OfALateTrialIsARestart) {
  EXPECT_EQ(classify(true, std::nullopt, true), Health::Restart);
  EXPECT_EQ(classify(true, 30s, true), Health::Restart) << "the service comes and goes";
  EXPECT_EQ(classify(true, 60s, true), Health::Good);
}

TEST(Health, OfAProvenSlotIsNeverARestart) {
  EXPECT_EQ(classify(false, 0s, false), Health::Good);
  EXPECT_EQ(classify(false, std::nullopt, false), Health::Wait);
  EXPECT_EQ(classify(false, std::nullopt, true), Health::Wait);
}

}  // namespace
}  // namespace adit::update
