#include "clock/chrony.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>
#include <vector>

namespace adit::clock {
namespace {

using testing::HasSubstr;
using testing::Not;

const Ntp kAsks{.server = "10.0.0.5", .clients = ""};
const Ntp kGives{.server = "", .clients = "10.0.0.0/24"};
const Ntp kBoth{.server = "10.0.0.5", .clients = "10.0.0.0/24"};
constexpr Source kSources[] = {Source::None, Source::LastKnown, Source::Robots, Source::CommandPost,
                               Source::Chip, Source::Operator,  Source::Ntp};

TEST(Chrony, IsBoundToTheTeamNetworkWithoutACommandPort) {
  for (const Ntp& ntp : {kAsks, kGives, kBoth}) {
    for (const Source source : kSources) {
      const std::string text = chrony_for(ntp, source, "team7").configuration;
      EXPECT_THAT(text, HasSubstr("\nbindacqdevice team7\nbinddevice team7\n"));
      EXPECT_THAT(text, HasSubstr("\nbindcmdaddress 127.0.0.1\nbindcmdaddress /\n"));
    }
  }
}

TEST(Chrony, SetsTheClockOnlyOnceItsTimeWasAccepted) {
  for (const Source source : kSources) {
    const Chrony chrony = chrony_for(kAsks, source, "team0");
    EXPECT_THAT(chrony.configuration, HasSubstr("\nserver 10.0.0.5 iburst"));
    const bool keeps = source == Source::Ntp;
    EXPECT_EQ(chrony.options, keeps ? "CHRONYD=\n" : "CHRONYD=-x\n") << static_cast<int>(source);
    EXPECT_EQ(chrony.configuration.contains("\nmaxchange 60 0 -1\n"), keeps);
  }
  EXPECT_EQ(chrony_for(kGives, Source::Ntp, "team0").options, "CHRONYD=-x\n")
      << "the old server must be gone";
}

TEST(Chrony, ServesNoUnsetTime) {
  for (const Ntp& ntp : {kGives, kBoth}) {
    for (const Source source : kSources) {
      const Chrony chrony = chrony_for(ntp, source, "team0");
      const bool gives = is_set(source);
      EXPECT_EQ(chrony.configuration.contains("\nallow 10.0.0.0/24\nlocal stratum 10\n"), gives);
      EXPECT_EQ(chrony.configuration.contains("\nport 0\n"), !gives);
      EXPECT_EQ(chrony.firewall.contains("ntp_clients { 10.0.0.0/24 }"), gives);
    }
  }
  EXPECT_THAT(chrony_for(kAsks, Source::Operator, "team0").configuration, HasSubstr("\nport 0\n"));
}

TEST(Chrony, AdmitsOnlyItsServerAndClients) {
  const Chrony chrony = chrony_for(kAsks, Source::Operator, "team0");
  EXPECT_THAT(chrony.firewall, HasSubstr("flush set inet adit ntp_servers\n"));
  EXPECT_THAT(chrony.firewall, HasSubstr("flush set inet adit ntp_clients\n"));
  EXPECT_THAT(chrony.firewall, HasSubstr("add element inet adit ntp_servers { 10.0.0.5 }\n"));
  EXPECT_THAT(chrony.firewall, Not(HasSubstr("add element inet adit ntp_clients")));
}

/// An answer of chronyd 4.3, which did not set the clock. The clock was 90 days behind 10.0.0.5.
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

TEST(Tracking, IsReadFromTheReplyOfChronyd) {
  const auto tracking = read_tracking(told(), 7);
  ASSERT_TRUE(tracking);
  EXPECT_EQ(tracking->server, 0x0a000005U);
  EXPECT_NEAR(tracking->heard, 1795439409.217, 1e-3);
  EXPECT_NEAR(tracking->behind, 7775999, 1e-3);
}

TEST(Tracking, HasNoServerIfNoneIsHeard) {
  auto silent = told();
  silent[55] = 3;  // "Not synchronised"
  ASSERT_TRUE(read_tracking(silent, 7));
  EXPECT_EQ(read_tracking(silent, 7)->server, 0U);
  auto local = told();
  local[49] = 0;  // no address: its own clock
  ASSERT_TRUE(read_tracking(local, 7));
  EXPECT_EQ(read_tracking(local, 7)->server, 0U);
}

TEST(Tracking, IsReadFromNoOtherMessage) {
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

TEST(Tracking, RequestHasANumberAndTheLengthOfTheReply) {
  const auto request = tracking_request(0x01020304);
  EXPECT_EQ(request.size(), told().size());
  EXPECT_EQ((std::vector<std::uint8_t>{request.begin(), request.begin() + 12}),
            (std::vector<std::uint8_t>{6, 1, 0, 0, 0, 33, 0, 0, 1, 2, 3, 4}));
}

}  // namespace
}  // namespace adit::clock
