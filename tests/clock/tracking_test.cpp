#include "clock/tracking.hpp"

#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace adit::clock {
namespace {

/// As chronyd 4.3 told it, which did not set the clock; by it the clock was 90 days behind 10.0.0.5.
constexpr std::string_view kTold =
    "060200000021000500000000000000000000000700000000000000000a0000050a00000500000000000000000000000000010000"
    "00040000"
    "000000006b043b310cef70b4db73ce703112b20230ed4dfefaa253dfeec1c95906e302b6e2c815c8e881a6920881f89a";

std::vector<std::uint8_t> told() {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < kTold.size(); i += 2)
    bytes.push_back(static_cast<std::uint8_t>(digit(kTold[i]) * 16 + digit(kTold[i + 1])));
  return bytes;
}

TEST(Tracking, IsReadAsChronydTellsIt) {
  const auto tracking = read_tracking(told(), 7);
  ASSERT_TRUE(tracking);
  EXPECT_EQ(tracking->server, 0x0a000005U);
  EXPECT_NEAR(tracking->heard, 1795439409.217, 1e-3);
  EXPECT_NEAR(tracking->behind, 7775999, 1e-3);
}

TEST(Tracking, IsOfNobodyWhereNobodyIsHeard) {
  auto silent = told();
  silent[55] = 3;  // "Not synchronised"
  ASSERT_TRUE(read_tracking(silent, 7));
  EXPECT_EQ(read_tracking(silent, 7)->server, 0U);
  auto local = told();
  local[49] = 0;  // by no address: its own clock
  ASSERT_TRUE(read_tracking(local, 7));
  EXPECT_EQ(read_tracking(local, 7)->server, 0U);
}

TEST(Tracking, IsNoOtherMessage) {
  EXPECT_FALSE(read_tracking(told(), 8)) << "the reply to another request";
  for (const std::size_t at : {0U, 1U, 5U, 7U, 9U}) {
    auto other = told();
    other[at] ^= 1;
    EXPECT_FALSE(read_tracking(other, 7)) << at;
  }
  auto bytes = told();
  while (!bytes.empty()) {
    bytes.pop_back();
    EXPECT_FALSE(read_tracking(bytes, 7)) << bytes.size();
  }
}

TEST(Tracking, IsAskedForByANumberInAsManyBytesAsTheReplyHas) {
  const auto request = tracking_request(0x01020304);
  EXPECT_EQ(request.size(), told().size());
  EXPECT_EQ((std::vector<std::uint8_t>{request.begin(), request.begin() + 12}),
            (std::vector<std::uint8_t>{6, 1, 0, 0, 0, 33, 0, 0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace adit::clock
