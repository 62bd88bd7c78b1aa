#include "box/links.hpp"

#include <gmock/gmock.h>

#include <map>

namespace adit::box {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

class LinksTest : public testing::Test {
 protected:
  LinksTest() {
    settings.team.interface = "team0";
    settings.command_post.interface = "darpa0";
  }
  Links make() {
    return {loop, settings, [this](const std::string& name) { return carriers[name]; }, [this] { ++changes; },
            [this] { ++backs; }};
  }
  void wait() {
    const auto end = loop.now() + 2 * Links::kEvery;
    while (loop.now() < end) loop.turn(std::chrono::milliseconds(20));
    loop.turn(std::chrono::milliseconds(0));  // what is due by then
  }

  loop::Loop loop;
  settings::Settings settings;
  std::map<std::string, std::optional<bool>> carriers{{"team0", true}, {"darpa0", true}};
  int changes = 0, backs = 0;
};

TEST_F(LinksTest, AreShownAsTheyAre) {
  carriers["darpa0"] = false;
  const Links links = make();
  const auto rows = links.rows();
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].side, "team");
  EXPECT_EQ(rows[0].carrier, true);
  EXPECT_EQ(rows[1].interface, "darpa0");
  EXPECT_EQ(rows[1].carrier, false);
  EXPECT_THAT(links.attention(), ElementsAre("the Command Post's cable is out: darpa0 has no carrier"));
}

TEST_F(LinksTest, AreToldWhereThereIsNoSuchInterface) {
  carriers["team0"] = std::nullopt;
  EXPECT_THAT(make().attention(), ElementsAre("there is no interface team0"));
}

TEST_F(LinksTest, AreNoneWhereTheSettingsNameNone) {
  settings = {};
  const Links links = make();
  EXPECT_THAT(links.rows(), IsEmpty());
  EXPECT_THAT(links.attention(), IsEmpty());
}

TEST_F(LinksTest, TellWhenTheCommandPostsCableIsBack) {
  const Links links = make();
  wait();
  EXPECT_EQ(changes, 0);
  carriers["darpa0"] = false;
  wait();
  EXPECT_EQ(changes, 1);
  EXPECT_EQ(backs, 0);
  EXPECT_EQ(links.attention().size(), 1u);
  carriers["darpa0"] = true;
  wait();
  EXPECT_EQ(changes, 2);
  EXPECT_EQ(backs, 1);
  EXPECT_THAT(links.attention(), IsEmpty());
  carriers["team0"] = false;
  wait();
  carriers["team0"] = true;
  wait();
  EXPECT_EQ(changes, 4);
  EXPECT_EQ(backs, 1) << "nothing waits for the team's";
}

TEST_F(LinksTest, AreThoseThatTheSettingsNameByNow) {
  Links links = make();
  settings.command_post.interface = "darpa1";
  carriers["darpa1"] = false;
  links.look_at(settings);
  EXPECT_THAT(links.attention(), ElementsAre("the Command Post's cable is out: darpa1 has no carrier"));
  EXPECT_EQ(backs, 0);
}

}  // namespace
}  // namespace adit::box
