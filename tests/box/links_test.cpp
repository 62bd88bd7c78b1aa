#include <gmock/gmock.h>
#include <sys/socket.h>

#include <array>
#include <map>

#include "box/this_box.hpp"

namespace adit::box {
namespace {

using testing::IsEmpty;

class LinksTest : public testing::Test {
 protected:
  LinksTest() {
    settings.team.interface = "team0";
    settings.command_post.interface = "darpa0";
  }
  Links make(loop::FileDescriptor told = {}) {
    return {loop,
            settings,
            [this](const std::string& name) { return carriers[name]; },
            std::move(told),
            [this] { ++changes; },
            [this] { ++backs; }};
  }

  loop::Loop loop;
  settings::Settings settings;
  std::map<std::string, std::optional<bool>> carriers{{"team0", true}, {"darpa0", true}};
  int changes = 0, backs = 0;
};

TEST_F(LinksTest, ShowEachCarrier) {
  carriers["darpa0"] = false;
  const Links links = make();
  const auto rows = links.rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].side, "team");
  EXPECT_EQ(rows[0].carrier, true);
  EXPECT_EQ(rows[1].interface, "darpa0");
  EXPECT_EQ(rows[1].carrier, false);
}

TEST_F(LinksTest, ShowAMissingInterface) {
  carriers["team0"] = std::nullopt;
  EXPECT_EQ(make().rows()[0].carrier, std::nullopt);
}

TEST_F(LinksTest, AreEmptyWithoutInterfacesInTheSettings) {
  settings = {};
  const Links links = make();
  EXPECT_THAT(links.rows(), IsEmpty());
}

TEST_F(LinksTest, ReportTheReturnOfTheCommandPostCable) {
  Links links = make();
  links.refresh();
  EXPECT_EQ(changes, 0);
  carriers["darpa0"] = false;
  links.refresh();
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(backs, 0);
  EXPECT_EQ(links.rows()[1].carrier, false);
  carriers["darpa0"] = true;
  links.refresh();
  EXPECT_EQ(changes, 2);
  EXPECT_EQ(backs, 1);
  carriers["team0"] = false;
  links.refresh();
  carriers["team0"] = true;
  links.refresh();
  EXPECT_EQ(changes, 4);
  EXPECT_EQ(backs, 1) << "the team's link has no waiting messages";
}

/// Events of the kernel's end of a socket, and its failure.
class LinkEventsTest : public LinksTest {
 protected:
  LinkEventsTest() {
    std::array<int, 2> ends{};
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends.data()), 0);
    kernel = loop::FileDescriptor(ends[0]);
    ours = loop::FileDescriptor(ends[1]);
  }
  void tell() { EXPECT_EQ(send(kernel.get(), "news", 4, 0), 4); }
  void turn() {  // one due event per turn
    for (int each = 0; each < 4; ++each) loop.turn(std::chrono::milliseconds(0));
  }

  loop::FileDescriptor kernel, ours;
};

TEST_F(LinkEventsTest, ReadTheCarrierAtEachKernelEvent) {
  const Links links = make(std::move(ours));
  carriers["darpa0"] = false;
  turn();
  EXPECT_EQ(changes, 0) << "links are read only on events";
  tell();
  tell();
  turn();
  EXPECT_EQ(changes, 1);
  carriers["darpa0"] = true;
  turn();
  EXPECT_EQ(backs, 0) << "earlier events must be discarded";
  tell();
  turn();
  EXPECT_EQ(backs, 1);
}

TEST_F(LinkEventsTest, PollIfKernelEventsFail) {
  kernel = {};
  Links links = make(std::move(ours));
  turn();
  carriers["darpa0"] = false;
  turn();
  EXPECT_EQ(changes, 0) << "a broken socket is not read again";
  links.refresh();
  EXPECT_EQ(changes, 1);
}

TEST_F(LinksTest, FollowTheSettings) {
  Links links = make();
  settings.command_post.interface = "darpa1";
  carriers["darpa1"] = false;
  links.watch_settings(settings);
  EXPECT_EQ(links.rows()[1].carrier, false);
  EXPECT_EQ(backs, 0);
}

}  // namespace
}  // namespace adit::box
