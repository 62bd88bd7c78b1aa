#include "clock/chrony.hpp"

#include <gmock/gmock.h>

namespace adit::clock {
namespace {

using testing::HasSubstr;
using testing::Not;

const Ntp kAsks{.server = "10.0.0.5", .clients = ""};
const Ntp kGives{.server = "", .clients = "10.0.0.0/24"};
const Ntp kBoth{.server = "10.0.0.5", .clients = "10.0.0.0/24"};
constexpr Source kSources[] = {Source::None, Source::LastKnown, Source::Robots, Source::CommandPost,
                               Source::Chip, Source::Operator,  Source::Ntp};

TEST(Chrony, IsBoundToTheTeamsNetworkAndTakesNoOrders) {
  for (const Ntp& ntp : {kAsks, kGives, kBoth}) {
    for (const Source source : kSources) {
      const std::string text = chrony_for(ntp, source, "team7").configuration;
      EXPECT_THAT(text, HasSubstr("\nbindacqdevice team7\nbinddevice team7\n"));
      EXPECT_THAT(text, HasSubstr("\nbindcmdaddress 127.0.0.1\nbindcmdaddress /\n"));
    }
  }
}

TEST(Chrony, SetsNoClockUntilItsTimeWasTakenAndThenKeepsItWithinAMinute) {
  for (const Source source : kSources) {
    const Chrony chrony = chrony_for(kAsks, source, "team0");
    EXPECT_THAT(chrony.configuration, HasSubstr("\nserver 10.0.0.5 iburst"));
    const bool keeps = source == Source::Ntp;
    EXPECT_EQ(chrony.options, keeps ? "CHRONYD=\n" : "CHRONYD=-x\n") << static_cast<int>(source);
    EXPECT_EQ(chrony.configuration.contains("\nmaxchange 60 0 -1\n"), keeps);
  }
  EXPECT_EQ(chrony_for(kGives, Source::Ntp, "team0").options, "CHRONYD=-x\n")
      << "its server is asked no more";
}

TEST(Chrony, GivesNobodyATimeThatIsNotSet) {
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

TEST(Chrony, LetsInNobodyButWhomItSpeaksWith) {
  const Chrony chrony = chrony_for(kAsks, Source::Operator, "team0");
  EXPECT_THAT(chrony.firewall, HasSubstr("flush set inet adit ntp_servers\n"));
  EXPECT_THAT(chrony.firewall, HasSubstr("flush set inet adit ntp_clients\n"));
  EXPECT_THAT(chrony.firewall, HasSubstr("add element inet adit ntp_servers { 10.0.0.5 }\n"));
  EXPECT_THAT(chrony.firewall, Not(HasSubstr("add element inet adit ntp_clients")));
}

}  // namespace
}  // namespace adit::clock
