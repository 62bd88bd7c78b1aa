#include "alarms/arrival.hpp"

#include <gtest/gtest.h>

#include "alarms/alike.hpp"

namespace adit::alarms {
namespace {

struct ArrivalCase {
  const char* what;
  ActivityRow row;
  double turn = 0;
  bool silent = false;
  Arrival arrival;
  Level level;
};

const ArrivalCase kArrivalCases[] = {
    {"nothing waits",
     {.last_forwarded = kNow, .heard = 3, .last_status = 200},
     0,
     false,
     Arrival::UpToDate,
     Level::Good},
    {"something waits for its turn",
     {.last_forwarded = kNow, .age = 9, .heard = 9, .last_status = 200},
     0,
     false,
     Arrival::Arriving,
     Level::Good},
    {"it waits longer",
     {.last_forwarded = kNow, .age = 11, .heard = 11, .last_status = 200},
     0,
     false,
     Arrival::Late,
     Level::Wait},
    {"as long as many explain",
     {.last_forwarded = kNow, .age = 25, .heard = 25, .last_status = 200},
     20,
     false,
     Arrival::Arriving,
     Level::Good},
    {"and longer than they do",
     {.last_forwarded = kNow, .age = 31, .heard = 31, .last_status = 200},
     20,
     false,
     Arrival::Late,
     Level::Wait},
    {"for good",
     {.last_forwarded = kNow, .age = 91, .heard = 99, .last_status = 200},
     0,
     false,
     Arrival::NotArriving,
     Level::Bad},
    {"the last try failed",
     {.last_forwarded = kNow, .age = 3, .heard = 9, .last_sentence = "timed out"},
     0,
     false,
     Arrival::Failing,
     Level::Wait},
    {"and those before it",
     {.last_forwarded = kNow, .age = 11, .heard = 20, .last_sentence = "timed out"},
     0,
     false,
     Arrival::NotArriving,
     Level::Bad},
    {"429",
     {.last_forwarded = kNow, .age = 3, .heard = 9, .last_status = 429, .last_sentence = "timed out"},
     0,
     false,
     Arrival::Throttled,
     Level::Wait},
    {"refused for good",
     {.last_forwarded = kNow, .heard = 9, .last_status = 422, .last_sentence = "timed out"},
     0,
     false,
     Arrival::Refused,
     Level::Bad},
    {"the first waits", {.age = 1}, 0, false, Arrival::NotYet, Level::Wait},
    {"nothing new",
     {.last_forwarded = kNow, .heard = 61, .last_status = 200},
     0,
     false,
     Arrival::Quiet,
     Level::Quiet},
    {"its robot is silent",
     {.last_forwarded = kNow, .heard = 61, .last_status = 200},
     0,
     true,
     Arrival::Silent,
     Level::Bad},
};

TEST(Arrival, HasOneWordAndOneLevelForEachCase) {
  for (const ArrivalCase& each : kArrivalCases) {
    const Arrival arrival = arrival_of(each.row, each.turn, each.silent);
    EXPECT_EQ(name_of(arrival), name_of(each.arrival)) << each.what;
    EXPECT_EQ(level_of(arrival), each.level) << each.what;
  }
}

}  // namespace
}  // namespace adit::alarms
