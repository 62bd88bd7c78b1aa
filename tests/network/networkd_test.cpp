#include "network/networkd.hpp"

#include <gmock/gmock.h>

#include "network/doubles.hpp"

namespace adit::network {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(NetworkdFiles, GiveAnInterfaceOneStaticAddressAndNothingElse) {
  for (const std::string& file :
       {team_file("team0", numbers()),
        command_post_file("darpa0", numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.1.1"))}) {
    for (const char* line :
         {"DHCP=no\n", "LinkLocalAddressing=no\n", "IPv6AcceptRA=no\n", "KeepConfiguration=no\n",
          "DuplicateAddressDetection=none\n", "ConfigureWithoutCarrier=yes\n"}) {
      EXPECT_THAT(file, HasSubstr(line));
    }
    for (const char* never : {"DNS=1", "Forward", "Masquerade", "0.0.0.0/0", "DefaultRoute"}) {
      EXPECT_THAT(file, Not(HasSubstr(never)));
    }
  }
  EXPECT_THAT(team_file("team0", numbers()), HasSubstr("[Match]\nName=team0\n"));
  EXPECT_THAT(team_file("team0", numbers()), HasSubstr("[Address]\nAddress=192.168.7.11/24\n"));
  EXPECT_THAT(team_file("team0", numbers()), Not(HasSubstr("[Route]")));
  EXPECT_THAT(command_post_file("darpa0", numbers()), HasSubstr("Name=darpa0\n"));
  EXPECT_THAT(command_post_file("darpa0", numbers()), Not(HasSubstr("[Route]")));
}

TEST(NetworkdFiles, LeadByTheGatewayToTheCommandPostAlone) {
  const std::string file =
      command_post_file("darpa0", numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.1.1"));
  for (const char* route : {"[Route]\nDestination=10.1.1.0/24\nGateway=10.100.1.1\n",
                            "[Route]\nDestination=10.2.1.0/24\nGateway=10.100.1.1\n",
                            "[Route]\nDestination=10.100.0.0/16\nGateway=10.100.1.1\n"}) {
    EXPECT_THAT(file, HasSubstr(route));
  }
}

TEST(NetworkdFiles, NeedNoRouteToTheirOwnSubnet) {
  const std::string file =
      command_post_file("darpa0", numbers("192.168.7.11/24", "10.100.1.10/16", "10.100.0.1"));
  EXPECT_THAT(file, Not(HasSubstr("Destination=10.100.0.0/16")));
  EXPECT_THAT(file, HasSubstr("Destination=10.2.1.0/24"));
}

}  // namespace
}  // namespace adit::network
