#include "admin/team_ports.hpp"

#include <gtest/gtest.h>

#include "host/folder.hpp"
#include "host/service.hpp"
#include "loop/simulated_time.hpp"

namespace adit::admin {
namespace {

using namespace std::chrono_literals;

class TeamPortsTest : public testing::Test {
 protected:
  /// The ports that are requested in this second; std::nullopt: no request.
  std::optional<network::TeamPorts> asked(const network::TeamPorts& ports) {
    team_ports_.every_second(ports);
    const auto text = host::read_file(state_ / network::kPortsFile);
    if (!text) return std::nullopt;
    EXPECT_TRUE(host::remove_file(state_ / network::kPortsFile));
    return *codec::read_file<network::TeamPorts>(*text);
  }
  void open(const network::TeamPorts& ports) { run_.put(network::kPortRulesFile, network::rules_for(ports)); }

  const network::TeamPorts kFirst{{80, 8000}}, kMore{{80, 8000, 9000}};
  host::Folder state_, run_;
  loop::SimulatedTime time_;
  loop::Loop loop_;
  TeamPorts team_ports_{loop_, state_.path(), run_.path()};
};

TEST_F(TeamPortsTest, FirstPortsNeedNoRequest) {
  EXPECT_FALSE(asked(kFirst));
  EXPECT_FALSE(asked({{8000}}));
  EXPECT_FALSE(asked({}));
}

TEST_F(TeamPortsTest, OtherPortsAreRequestedUntilTheyAreOpen) {
  EXPECT_EQ(asked(kMore), kMore);
  EXPECT_FALSE(asked(kMore)) << "not each second";
  time_.pass(loop_, TeamPorts::kAskAgain);
  EXPECT_EQ(asked(kMore), kMore);
  open(kMore);
  EXPECT_FALSE(asked(kMore));
}

TEST_F(TeamPortsTest, UnreadRequestIsNotWrittenAgain) {
  team_ports_.every_second(kMore);
  state_.put(network::kPortsFile, "as it was");
  time_.pass(loop_, TeamPorts::kAskAgain);
  team_ports_.every_second(kMore);
  EXPECT_EQ(host::read_file(state_ / network::kPortsFile), "as it was") << "a write to the disk each minute";
}

TEST_F(TeamPortsTest, RemovedPortsAreClosed) {
  open(kMore);
  EXPECT_EQ(asked(kFirst), kFirst);
  EXPECT_EQ(asked(kMore), std::nullopt) << "they are open";
  EXPECT_EQ(asked({}), network::TeamPorts{});
}

}  // namespace
}  // namespace adit::admin
