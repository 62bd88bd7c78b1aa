#include <gtest/gtest.h>

#include "host/folder.hpp"
#include "host/interfaces.hpp"
#include "host/service.hpp"

namespace adit::host {
namespace {

TEST(Carrier, IsThatOfTheKernel) {
  const Folder net;
  std::filesystem::create_directory(net / "darpa0");
  net.put("darpa0/carrier", "1\n");
  EXPECT_EQ(carrier_in(net.path(), "darpa0"), true);
  net.put("darpa0/carrier", "0\n");
  EXPECT_EQ(carrier_in(net.path(), "darpa0"), false);
}

TEST(Carrier, WithoutAnInterfaceIsPresent) {
  EXPECT_EQ(carrier(""), true);
}

TEST(Carrier, OfAnUnknownInterfaceIsUnknown) {
  EXPECT_EQ(carrier("nosuch0"), std::nullopt);
}

TEST(Carrier, FollowsNoPathInAName) {
  const Folder net;
  std::filesystem::create_directory(net / "sub");
  std::filesystem::create_directory(net / "sub/eth0");
  net.put("carrier", "1\n");
  net.put("sub/carrier", "1\n");
  net.put("sub/eth0/carrier", "1\n");
  for (const std::string name : {".", "..", "sub/eth0", "a/../../x", "interface-longer-than-15"}) {
    EXPECT_EQ(carrier_in(net.path() + "/sub", name), std::nullopt) << name;
    EXPECT_EQ(carrier_in(net.path(), name), std::nullopt) << name;
  }
}

}  // namespace
}  // namespace adit::host
