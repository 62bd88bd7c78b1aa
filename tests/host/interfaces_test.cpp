#include "host/interfaces.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "host/folder.hpp"

namespace adit::host {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::SizeIs;

TEST(Interfaces, ListLoopbackWithItsAddress) {
  const auto all = interfaces();
  ASSERT_TRUE(all) << all.error();
  const auto lo = std::ranges::find(*all, "lo", &Interface::name);
  ASSERT_NE(lo, all->end());
  EXPECT_TRUE(lo->up);
  EXPECT_THAT(lo->addresses, Contains("127.0.0.1/8"));
  EXPECT_EQ(std::ranges::count(*all, "lo", &Interface::name), 1);
}

class Ports : public testing::Test {
 protected:
  std::optional<Port> with(const char* mac, const char* speed, const char* duplex) {
    std::filesystem::create_directories(folder_.path() + "/eth0");
    const auto write = [this](const char* name, const char* text) {
      std::ofstream(folder_.path() + "/eth0/" + name) << text << '\n';
    };
    write("address", mac);
    write("speed", speed);
    write("duplex", duplex);
    return port_in(folder_.path(), "eth0").value();
  }
  Folder folder_;
};

TEST_F(Ports, ShowTheValuesOfTheDriver) {
  const auto port = with("02:00:00:00:00:01", "1000", "full");
  ASSERT_TRUE(port);
  EXPECT_EQ(port->mac, "02:00:00:00:00:01");
  EXPECT_EQ(port->mbit, 1000u);
  EXPECT_EQ(port->duplex, "full");
}

TEST_F(Ports, OmitUnknownValues) {
  for (const char* speed : {"-1", "", "0", "fast", "1000x", "99999999999"})
    EXPECT_FALSE(with("02", speed, "unknown")->mbit);
  EXPECT_EQ(with("02", "-1", "unknown")->duplex, "");
  for (const char* name : {"eth1", "", "..", "eth0/..", "a name"})
    EXPECT_FALSE(port_in(folder_.path(), name).value()) << name;
  EXPECT_TRUE(port("lo").value());
  EXPECT_THAT(local_name(), testing::MatchesRegex("[^.]+\\.local"));
}

TEST_F(Ports, UnreadableAreNotMissing) {
  std::filesystem::create_directories(folder_.path() + "/eth0/address");  // a directory cannot be read
  EXPECT_THAT(port_in(folder_.path(), "eth0").error(), testing::HasSubstr("eth0/address"));
}

TEST(Routes, AreReadFromTheKernelsTable) {
  const auto all = routes_in(
      "Iface\tDestination\tGateway \tFlags\tRefCnt\tUse\tMetric\tMask\t\tMTU\tWindow\tIRTT\n"
      "darpa0\t00000000\t0101640A\t0003\t0\t0\t100\t00000000\t0\t0\t0\n"
      "team0\t0000000A\t00000000\t0001\t0\t0\t0\t00FFFFFF\t0\t0\t0\n");
  ASSERT_THAT(all, SizeIs(2));
  EXPECT_EQ(all[0].destination, "0.0.0.0/0");
  EXPECT_EQ(all[0].gateway, "10.100.1.1");
  EXPECT_EQ(all[0].interface, "darpa0");
  EXPECT_EQ(all[0].metric, 100);
  EXPECT_EQ(all[1].destination, "10.0.0.0/24");
  EXPECT_EQ(all[1].gateway, "");
}

TEST(Routes, SkipOtherEntries) {
  EXPECT_THAT(routes_in(""), IsEmpty());
  EXPECT_THAT(routes_in("lo\tnothing\n\nlo 0 0\n"), IsEmpty());
}

}  // namespace
}  // namespace adit::host
