#include <gtest/gtest.h>

#include "uplink/connection.hpp"

namespace adit::uplink {
namespace {

using std::chrono::seconds;

TEST(ConnectAttempts, PauseDoublesUpToFiveSecondsWhileTheyFail) {
  ConnectAttempts attempts;
  const loop::Instant now(seconds{100});
  attempts.on_begun(now);
  for (const int pause : {1, 2, 4, 5, 5}) EXPECT_EQ(attempts.on_failed("refused"), now + seconds{pause});
  EXPECT_EQ(attempts.trouble(), "refused");
  attempts.retry_now();
  EXPECT_EQ(attempts.on_failed("no route"), now + seconds{1});
  EXPECT_EQ(attempts.trouble(), "no route");
  attempts.on_succeeded();
  EXPECT_EQ(attempts.next(), now + seconds{1});
  EXPECT_EQ(attempts.trouble(), "");
}

}  // namespace
}  // namespace adit::uplink
