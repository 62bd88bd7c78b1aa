#include "host/interfaces.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace adit::host {
namespace {

using testing::Contains;
using testing::IsEmpty;
using testing::SizeIs;

TEST(Interfaces, TellLoopbackWithItsAddress) {
  const auto all = interfaces();
  ASSERT_TRUE(all) << all.error();
  const auto lo = std::ranges::find(*all, "lo", &Interface::name);
  ASSERT_NE(lo, all->end());
  EXPECT_TRUE(lo->up);
  EXPECT_THAT(lo->addresses, Contains("127.0.0.1/8"));
  EXPECT_EQ(std::ranges::count(*all, "lo", &Interface::name), 1);
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

TEST(Routes, LeaveOutWhatIsNoRoute) {
  EXPECT_THAT(routes_in(""), IsEmpty());
  EXPECT_THAT(routes_in("lo\tnothing\n\nlo 0 0\n"), IsEmpty());
}

}  // namespace
}  // namespace adit::host
