#include <gmock/gmock.h>

#include "network/change.hpp"
#include "network/doubles.hpp"

namespace adit::network {
namespace {

using testing::HasSubstr;
using testing::Not;

const std::vector<std::uint32_t> kEndpoints = {*settings::ipv4_of("10.100.1.200"),
                                               *settings::ipv4_of("10.100.2.201")};

Numbers several() {
  Numbers all = numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.1.1");
  all.command_post.push_back(host("10.100.3.10/24"));
  all.command_post.push_back(host("10.100.1.11/24"));
  return all;
}

TEST(NetworkdFiles, IgnoreOffersOfANetwork) {
  for (const std::string& file :
       {team_file("team0", numbers()), team_file("team0", with_mode(Mode::LinkLocal)),
        command_post_file("darpa0", several(), kEndpoints)}) {
    for (const char* line : {"DHCP=no\n", "IPv6AcceptRA=no\n", "LLMNR=no\n", "LLDP=no\n", "EmitLLDP=no\n",
                             "KeepConfiguration=no\n", "ConfigureWithoutCarrier=yes\n",
                             "IgnoreCarrierLoss=yes\n", "RequiredForOnline=no\n"}) {
      EXPECT_THAT(file, HasSubstr(line));
    }
    for (const char* never : {"DNS=1", "Forward", "Masquerade", "0.0.0.0/0", "DefaultRoute"}) {
      EXPECT_THAT(file, Not(HasSubstr(never)));
    }
  }
}

TEST(NetworkdFiles, GiveTheTeamSideAddressesAndAName) {
  const std::string file = team_file("team0", numbers());
  for (const char* line :
       {"[Match]\nName=team0\n", "[Address]\nAddress=192.168.7.11/24\n", "DuplicateAddressDetection=none\n",
        "LinkLocalAddressing=yes\n", "MulticastDNS=yes\n"}) {
    EXPECT_THAT(file, HasSubstr(line));
  }
  EXPECT_THAT(file, Not(HasSubstr("[Route]")));
  EXPECT_THAT(file, Not(HasSubstr("AddPrefixRoute")));
}

TEST(NetworkdFiles, AcceptOnlyAnAddressFromDhcp) {
  const std::string file = team_file("team0", with_mode(Mode::Dhcp));
  for (const char* line : {"DHCP=ipv4\n", "UseGateway=no\n", "UseRoutes=no\n", "UseDNS=no\n", "UseNTP=no\n",
                           "IgnoreCarrierLoss=5s\n", "LinkLocalAddressing=yes\n"}) {
    EXPECT_THAT(file, HasSubstr(line));
  }
  EXPECT_THAT(file, Not(HasSubstr("[Address]")));
  EXPECT_THAT(team_file("team0", with_mode(Mode::LinkLocal)), Not(HasSubstr("[Address]")));
}

TEST(NetworkdFiles, KeepTheCommandPostSideSilent) {
  const std::string file = command_post_file("darpa0", numbers(), {});
  for (const char* line : {"[Match]\nName=darpa0\n", "LinkLocalAddressing=no\n", "MulticastDNS=no\n",
                           "Multicast=no\n", "[Address]\nAddress=10.100.1.10/24\nAddPrefixRoute=no\n"}) {
    EXPECT_THAT(file, HasSubstr(line));
  }
  Numbers none = numbers();
  none.command_post.clear();
  EXPECT_THAT(command_post_file("darpa0", none, kEndpoints), Not(HasSubstr("[Route]")));
  EXPECT_THAT(command_post_file("darpa0", none, kEndpoints), Not(HasSubstr("[Address]")));
}

TEST(NetworkdFiles, HaveTheirOwnRoutingTable) {
  const std::string file = command_post_file("darpa0", several(), {});
  for (const char* part :
       {"[Route]\nDestination=10.100.1.0/24\nScope=link\nPreferredSource=10.100.1.10\nTable=230\n",
        "[Route]\nDestination=10.100.3.0/24\nScope=link\nPreferredSource=10.100.3.10\nTable=230\n",
        "[RoutingPolicyRule]\nOutgoingInterface=darpa0\nFamily=ipv4\nPriority=230\nTable=230\n",
        "[RoutingPolicyRule]\nFrom=10.100.1.11/32\nPriority=230\nTable=230\n"}) {
    EXPECT_THAT(file, HasSubstr(part));
  }
  EXPECT_THAT(file, Not(HasSubstr("PreferredSource=10.100.1.11"))) << "only one route to a subnet";
}

TEST(NetworkdFiles, RouteOnlyRemoteEndpointsByTheGateway) {
  const std::string file = command_post_file("darpa0", several(), kEndpoints);
  EXPECT_THAT(file, HasSubstr("[Route]\nDestination=10.100.2.201/32\nGateway=10.100.1.1\n"
                              "PreferredSource=10.100.1.10\nTable=230\n"));
  EXPECT_THAT(file, Not(HasSubstr("10.100.1.200/32"))) << "the endpoint is in a subnet";
  EXPECT_THAT(command_post_file("darpa0", numbers(), kEndpoints), Not(HasSubstr("/32\nGateway")));
}

}  // namespace
}  // namespace adit::network
