#include "admin/network_change.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <filesystem>
#include <fstream>

#include "host/folder.hpp"
#include "host/interfaces.hpp"
#include "loop/simulated_time.hpp"
#include "network/doubles.hpp"

namespace adit::admin {
namespace {

using network::Mode;
using network::numbers;
using testing::HasSubstr;

class NetworkChangeTest : public testing::Test {
 protected:
  NetworkChangeTest() {
    settings.team.interface = "team0";
    settings.team.listen = {{"0.0.0.0", 8000}};
    settings.command_post.interface = "darpa0";
    settings.command_post.scoring = {"10.100.1.201", 8000};
    settings.command_post.mapping = {"10.100.1.200", 8000};
    status.kept = numbers();
    write_status();
  }

  /// Writes the status as adit-network does. It is read again once it is too old.
  void write_status() {
    std::ofstream(folder / host::kStatusFile) << codec::write_file(status);
    time.pass(host::kFresh);
  }
  std::optional<network::Endpoints> asked() const {
    std::ifstream file(folder / network::kEndpointsFile);
    const std::string text(std::istreambuf_iterator<char>(file), {});
    const auto read = codec::read_file<network::Endpoints>(text);
    return read ? std::optional(*read) : std::nullopt;
  }
  void wait(const network::Numbers& wanted) {
    status.pending = network::Pending{std::string(32, 'a'), wanted, loop.now() + std::chrono::seconds(60),
                                      std::chrono::seconds(60)};
    write_status();
  }

  host::Folder folder;
  loop::SimulatedTime time;
  loop::Loop loop;
  settings::Settings settings;
  network::Status status{.team_interface = "team0", .command_post_interface = "darpa0"};
  host::RootProgram<network::Status> adit_network{loop, "adit-network", folder.path(), folder.path(),
                                                  NetworkChange::kTakenUpWithin};
  NetworkChange change{loop, settings, adit_network, folder.path()};
};

TEST_F(NetworkChangeTest, SendsAllEndpointsUntilAditNetworkKnowsThem) {
  settings.courses = {{"B", {"10.100.2.200", 8000}, {"10.100.1.201", 8000}},
                      {"C", {"fd00::1", 8000}, {"10.0.0.9", 8000}}};
  change.every_second();
  const network::Endpoints all{{0x0a000009, 0x0a6401c8, 0x0a6401c9, 0x0a6402c8}};
  EXPECT_EQ(asked(), all) << "sorted, unique, only IPv4";
  std::filesystem::remove(folder / network::kEndpointsFile);
  change.every_second();
  EXPECT_EQ(asked(), std::nullopt) << "a repeated request came too soon";
  status.endpoints = all;
  write_status();
  NetworkChange another(loop, settings, adit_network, folder.path());
  another.every_second();
  EXPECT_EQ(asked(), std::nullopt) << "the next hop is known";
}

TEST_F(NetworkChangeTest, SendsNothingIfAditNetworkHasOtherInterfaces) {
  status.team_interface = "eth7";
  write_status();
  change.every_second();
  EXPECT_EQ(asked(), std::nullopt);
}

TEST_F(NetworkChangeTest, IsConfirmedOnlyAtTheNewAddress) {
  wait(numbers("192.168.8.11/24"));
  EXPECT_THAT(change.confirm("192.168.7.11").error().sentence,
              HasSubstr("confirm it at http://192.168.8.11:8000"));
  EXPECT_TRUE(change.confirm("192.168.8.11"));
}

TEST_F(NetworkChangeTest, ModeIsConfirmedAtAnyAddressButTheOld) {
  for (const Mode mode : {Mode::Dhcp, Mode::LinkLocal}) {
    wait(network::with_mode(mode));
    EXPECT_THAT(change.confirm("192.168.7.11").error().sentence,
                HasSubstr("confirm it at http://" + host::local_name() + ":8000"));
    EXPECT_TRUE(change.confirm("169.254.8.11"));
  }
}

TEST_F(NetworkChangeTest, HidesTheLastChangeWhileAnotherIsPending) {
  status.ended = network::ChangeOutcome::Confirmed;
  write_status();
  EXPECT_EQ(change.state().last, "confirmed");
  wait(numbers("192.168.8.11/24"));
  EXPECT_EQ(change.state().last, "");
}

TEST_F(NetworkChangeTest, FindsTheHopToTheCommandPost) {
  const settings::Address endpoint{"10.100.1.201", 8000};
  EXPECT_EQ(change.next_hop(endpoint), "10.100.1.201");
  status.kept = numbers("192.168.7.11/24", "10.100.3.10/24", "10.100.3.1");
  write_status();
  EXPECT_EQ(change.next_hop(endpoint), "10.100.3.1");
  status.kept = numbers("192.168.7.11/24", "10.100.3.10/24");
  write_status();
  EXPECT_EQ(change.next_hop(endpoint), "") << "no route exists";
}

TEST_F(NetworkChangeTest, TellsWhyAditNetworkCannotWork) {
  status.trouble = "confirmed.json: Input/output error";
  write_status();
  const api::NetworkView view = change.state();
  EXPECT_TRUE(view.runs_here) << "the error must be shown";
  EXPECT_FALSE(view.managed);
  EXPECT_EQ(view.why, "adit-network cannot work: confirmed.json: Input/output error");
  EXPECT_FALSE(change.change(numbers()));
}

TEST_F(NetworkChangeTest, TellsThatInterfacesCannotBeRead) {
  status.kept.reset();
  write_status();
  change.state();  // reads the status, which is then fresh
  rlimit before{};
  getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none{.rlim_cur = 0, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_NOFILE, &none);
  const api::NetworkView view = change.state();
  const auto hop = change.next_hop(settings.command_post.scoring);
  setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_THAT(view.why, HasSubstr("cannot read this machine's addresses"));
  EXPECT_TRUE(view.ports.empty()) << "no interface is shown as missing";
  ASSERT_FALSE(hop);
  EXPECT_THAT(hop.error(), HasSubstr("cannot read this machine's addresses"));
}

TEST_F(NetworkChangeTest, TellsThatTheCommandPostSideHasNoAddress) {
  EXPECT_FALSE(change.fact().no_address);
  status.kept->command_post.clear();
  write_status();
  EXPECT_TRUE(change.fact().no_address);
  wait(numbers());
  EXPECT_FALSE(change.fact().no_address) << "the pending change may set an address";
  EXPECT_GT(change.fact().confirm_within, 0);
}

class AddressConflictsTest : public NetworkChangeTest {
 protected:
  /// Writes the report of adit-network --watch.
  void write_conflicts(const std::vector<network::AddressConflict>& conflicts,
                       const std::vector<network::AddressConflict>& exchanged = {}) {
    std::ofstream(folder / network::kTakenFile)
        << codec::write_file(network::AddressConflicts{conflicts, exchanged});
    time.pass(host::kFresh);
  }
  network::AddressConflict on(const char* interface, const char* address, loop::Duration ago = {}) {
    return {interface, address, "02:00:00:00:00:07",
            std::chrono::floor<std::chrono::milliseconds>(loop.now() - ago)};
  }
  /// Each interface with its address.
  std::vector<std::string> conflicts() const {
    std::vector<std::string> all;
    for (const facts::AddressConflict& each : change.fact().taken)
      all.push_back((each.is_team ? "team " : "command post ") + each.interface + " " + each.address);
    return all;
  }
};

TEST_F(AddressConflictsTest, AreReportedOncePerSide) {
  EXPECT_TRUE(conflicts().empty()) << "adit-network --watch does not run";
  write_conflicts({on("darpa0", "10.100.1.10"), on("team0", "192.168.7.11"), on("darpa0", "10.100.2.10"),
                   on("eth7", "10.9.9.9")});
  EXPECT_EQ(conflicts(),
            (std::vector<std::string>{"team team0 192.168.7.11", "command post darpa0 10.100.1.10"}));
  EXPECT_EQ(change.fact().taken[0].mac, "02:00:00:00:00:07");
  write_conflicts({});
  EXPECT_TRUE(conflicts().empty());
}

TEST_F(AddressConflictsTest, CountForAWhile) {
  write_conflicts({on("team0", "192.168.7.11", network::kTakenFor / 2)});
  EXPECT_EQ(conflicts().size(), 1u);
  write_conflicts({on("team0", "192.168.7.11", network::kTakenFor)});
  EXPECT_TRUE(conflicts().empty()) << "adit-network --watch has ended";
}

TEST_F(AddressConflictsTest, ShowExchangedCables) {
  const auto exchanged = [this] {
    const auto found = change.fact().exchanged;
    return found ? found->address + ' ' + found->found_on + ' ' + found->sought_on : "";
  };
  EXPECT_EQ(exchanged(), "");
  write_conflicts({}, {on("team0", "10.100.1.77"), on("team0", "10.100.1.201")});
  EXPECT_EQ(exchanged(), "10.100.1.201 team0 darpa0");
  write_conflicts({}, {on("team0", "10.100.1.201", network::kTakenFor)});
  EXPECT_EQ(exchanged(), "") << "adit-network --watch has ended";
  write_conflicts({}, {on("team0", "10.100.1.77")});
  EXPECT_EQ(exchanged(), "") << "the report is about another course";
  status.kept = numbers("192.168.7.11/24", "10.100.3.10/24", "10.100.3.1");
  write_status();
  write_conflicts({}, {on("team0", "10.100.3.1")});
  EXPECT_EQ(exchanged(), "10.100.3.1 team0 darpa0") << "the gateway's address is exchanged";
}

TEST_F(AddressConflictsTest, AreEmptyIfTheFileIsDamaged) {
  std::ofstream(folder / network::kTakenFile) << R"({"format":1,"taken":[{"interface":"team0")";
  time.pass(host::kFresh);
  EXPECT_TRUE(conflicts().empty());
}

}  // namespace
}  // namespace adit::admin
