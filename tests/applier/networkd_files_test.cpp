#include "applier/networkd_files.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "host/folder.hpp"
#include "network/change.hpp"
#include "network/doubles.hpp"

namespace adit::applier {
namespace {

namespace fs = std::filesystem;
using network::numbers;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using testing::UnorderedElementsAreArray;

using Addresses = std::vector<std::uint32_t>;

std::expected<std::optional<Claim>, std::string> nobody(const std::string& interface, const Addresses&) {
  if (interface == "darpa0") return std::unexpected("darpa0: Network is down");
  return std::nullopt;
}
std::expected<std::optional<Claim>, std::string> somebody(const std::string& interface,
                                                          const Addresses& addresses) {
  const std::uint32_t taken = *settings::ipv4_of("192.168.8.11");
  if (interface == "darpa0" || std::ranges::find(addresses, taken) == addresses.end()) return std::nullopt;
  return Claim{.address = taken, .mac = "02:00:00:00:00:09", .own = ""};
}

class NetworkdFilesTest : public testing::Test {
 protected:
  NetworkdFilesTest() {
    for (const char* name : {"networkd", "state", "status"}) fs::create_directory(folder / name);
    options.status = folder / "status";
    options.networkd = folder / "networkd";
    options.factory = folder / "network.json";
    options.state = folder / "state";
    options.networkctl =
        folder.put("networkctl",
                   "#!/bin/sh\necho $1 >>" + (folder / "log") + "\ntest ! -e " + (folder / "broken"), 0700);
  }
  std::vector<std::string> in(const std::string& path) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(path)) names.push_back(entry.path().filename());
    return names;
  }
  std::string text(const std::string& path) const {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::size_t reloads() const {
    const std::string log = text(folder / "log");
    EXPECT_EQ(log.size() % 7, 0u) << log;  // "reload\n"
    return log.size() / 7;
  }
  /// Starts adit-network again, with or without a boot of the machine.
  void restart(bool machine) {
    if (machine) {
      for (const std::string& gone : {options.networkd, options.status})
        fs::remove_all(gone), fs::create_directory(gone);
      const auto written = NetworkdFiles(options, &nobody).write_at_start();
      EXPECT_TRUE(written) << written.error();
    }
    files = std::make_unique<NetworkdFiles>(options, &nobody);
    const auto settled = files->settle();
    EXPECT_TRUE(settled) << settled.error();
  }

  std::string text_of(const char* name) const { return text(options.networkd + '/' + name); }
  void come_with(const network::Numbers& numbers) {
    folder.put("network.json", network::write_kept(numbers));
  }

  host::Folder folder;
  Options options;
  std::unique_ptr<NetworkdFiles> files = std::make_unique<NetworkdFiles>(options, &nobody);
  const network::Numbers first = numbers(), second = numbers("192.168.8.11/24");
};

constexpr const char* kBothTried[] = {"04-adit-team.network", "04-adit-command-post.network"};
constexpr const char* kBothKept[] = {"05-adit-team.network", "05-adit-command-post.network"};

TEST_F(NetworkdFilesTest, StoreATrialBesideTheConfirmedFiles) {
  ASSERT_TRUE(files->settle());
  EXPECT_EQ(reloads(), 0u);
  ASSERT_TRUE(files->apply(first));
  EXPECT_THAT(in(options.networkd), UnorderedElementsAreArray(kBothTried));
  EXPECT_EQ(text_of("04-adit-team.network"), network::team_file("team0", first));
  EXPECT_EQ(reloads(), 1u);
  ASSERT_TRUE(files->revert());
  EXPECT_THAT(in(options.networkd), IsEmpty());
  EXPECT_EQ(reloads(), 2u);
}

TEST_F(NetworkdFilesTest, ConfirmWithoutAReload) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  EXPECT_EQ(in(options.networkd).size(), 4u);
  EXPECT_EQ(text_of("05-adit-command-post.network"), network::command_post_file("darpa0", first, {}));
  EXPECT_EQ(reloads(), 1u) << "networkd already has these files";
  ASSERT_TRUE(files->revert());
  EXPECT_EQ(reloads(), 1u) << "no change to revert";
}

TEST_F(NetworkdFilesTest, TouchOnlyTheInterfaceThatChanges) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  restart(true);
  ASSERT_TRUE(files->apply(second));
  EXPECT_EQ(in(options.networkd).size(), 3u);
  EXPECT_EQ(text_of("04-adit-team.network"), network::team_file("team0", second));
  ASSERT_TRUE(files->revert());
  EXPECT_THAT(in(options.networkd), UnorderedElementsAreArray(kBothKept));
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", first));
}

TEST_F(NetworkdFilesTest, RejectAnAddressInUse) {
  NetworkdFiles watchful(options, &somebody);
  EXPECT_EQ(watchful.apply(second).error(), "192.168.8.11 is already in use on team0, by 02:00:00:00:00:09");
  EXPECT_THAT(in(options.networkd), IsEmpty());
  EXPECT_EQ(reloads(), 0u);
  EXPECT_TRUE(watchful.apply(first));
}

TEST_F(NetworkdFilesTest, RejectAChangeIfTheFileInUseIsUnreadable) {
  ASSERT_TRUE(files->settle());
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  const std::string tried = options.networkd + "/04-adit-team.network";
  fs::remove(tried);
  fs::create_directory(tried);
  const auto applied = files->apply(first);
  ASSERT_FALSE(applied) << "networkd may use other addresses";
  EXPECT_THAT(applied.error(), HasSubstr(tried));
  EXPECT_FALSE(files->lead_to({.addresses = {1}}));
}

TEST_F(NetworkdFilesTest, RevertToWhatThisProcessConfirmed) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  ASSERT_TRUE(files->apply(second));
  ASSERT_TRUE(files->revert());
  EXPECT_EQ(in(options.networkd).size(), 3u) << "the confirmed files may stay";
  EXPECT_EQ(text_of("04-adit-team.network"), "");
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", first));
}

TEST_F(NetworkdFilesTest, LoseAnUnconfirmedChangeInAPowerCut) {
  ASSERT_TRUE(files->apply(first));
  restart(true);
  EXPECT_FALSE(files->has_unconfirmed_change());
  EXPECT_EQ(files->confirmed_numbers(), std::nullopt);
  EXPECT_THAT(in(options.networkd), IsEmpty());
}

TEST_F(NetworkdFilesTest, RevertAnUnconfirmedChangeAfterAKill) {
  ASSERT_TRUE(files->apply(first));
  restart(false);
  EXPECT_TRUE(files->has_unconfirmed_change());
  EXPECT_THAT(in(options.networkd), IsEmpty());
  EXPECT_EQ(reloads(), 2u);
}

TEST_F(NetworkdFilesTest, CompleteAnInterruptedConfirmation) {
  ASSERT_TRUE(files->apply(second));
  ASSERT_TRUE(files->keep(second));
  std::ofstream(options.networkd + "/05-adit-team.network") << network::team_file("team0", first);
  fs::remove(options.networkd + "/05-adit-command-post.network");
  restart(false);
  EXPECT_EQ(files->confirmed_numbers(), second);
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", second));
  EXPECT_EQ(text_of("05-adit-command-post.network"), network::command_post_file("darpa0", second, {}));
}

TEST_F(NetworkdFilesTest, UseFactoryAddressesUntilAChangeIsConfirmed) {
  come_with(first);
  restart(true);
  EXPECT_EQ(files->confirmed_numbers(), first);
  EXPECT_EQ(reloads(), 0u) << "networkd reads the files when it starts";
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", first));
  ASSERT_TRUE(files->apply(second));
  ASSERT_TRUE(files->keep(second));
  restart(true);
  EXPECT_EQ(files->confirmed_numbers(), second);
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", second));
}

TEST_F(NetworkdFilesTest, ForgetConfirmedAddresses) {
  come_with(first);
  restart(true);
  ASSERT_TRUE(files->lead_to({{0x0a6402c8}}));
  ASSERT_TRUE(files->apply(second));
  ASSERT_TRUE(files->keep(second));
  const auto forgotten = files->forget();
  ASSERT_TRUE(forgotten) << forgotten.error();
  EXPECT_EQ(*forgotten, first);
  EXPECT_THAT(in(options.state), IsEmpty());
  EXPECT_THAT(in(options.networkd), UnorderedElementsAreArray(kBothKept));
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", first));
}

TEST_F(NetworkdFilesTest, ForgetAllWithoutFactoryAddresses) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  EXPECT_EQ(files->forget().value(), std::nullopt);
  EXPECT_THAT(in(options.networkd), IsEmpty());
}

TEST_F(NetworkdFilesTest, RouteToNewEndpoints) {
  const network::Numbers routed = numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.1.1");
  const network::Endpoints elsewhere{{0x0a6402c8}}, near{{0x0a6401c8}};
  ASSERT_TRUE(files->apply(routed));
  ASSERT_TRUE(files->keep(routed));
  const std::size_t before = reloads();
  ASSERT_TRUE(files->lead_to(near));
  EXPECT_EQ(reloads(), before) << "the addresses are already on the link";
  ASSERT_TRUE(files->lead_to(elsewhere));
  EXPECT_EQ(reloads(), before + 1);
  for (const char* name : {"04-adit-command-post.network", "05-adit-command-post.network"}) {
    EXPECT_EQ(text_of(name), network::command_post_file("darpa0", routed, elsewhere.addresses)) << name;
  }
  ASSERT_TRUE(files->lead_to(elsewhere));
  EXPECT_EQ(reloads(), before + 1);
  restart(true);
  EXPECT_EQ(files->endpoints(), elsewhere);
  EXPECT_EQ(text_of("05-adit-command-post.network"),
            network::command_post_file("darpa0", routed, elsewhere.addresses));
}

TEST_F(NetworkdFilesTest, RouteToNewEndpointsDuringATrial) {
  come_with(first);
  restart(true);
  const network::Numbers routed = numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.1.1");
  ASSERT_TRUE(files->apply(routed));
  ASSERT_TRUE(files->lead_to({{0x0a6402c8}}));
  EXPECT_EQ(text_of("04-adit-command-post.network"),
            network::command_post_file("darpa0", routed, {0x0a6402c8}));
  EXPECT_EQ(text_of("04-adit-team.network"), "") << "that side does not change";
  ASSERT_TRUE(files->revert());
  EXPECT_THAT(in(options.networkd), UnorderedElementsAreArray(kBothKept));
}

TEST_F(NetworkdFilesTest, ReportAFailureAndRetry) {
  folder.put("broken", "");
  EXPECT_THAT(files->apply(first).error(), HasSubstr("networkctl reload: exit status 1"));
  EXPECT_FALSE(files->revert());
  fs::remove(folder / "broken");
  const std::size_t before = reloads();
  EXPECT_TRUE(files->revert());
  EXPECT_EQ(reloads(), before + 1) << "although the files were already removed";
  EXPECT_THAT(in(options.status), IsEmpty());
  fs::remove_all(options.networkd);
  EXPECT_THAT(files->apply(first).error(), HasSubstr(options.networkd));
  fs::remove_all(options.state);
  EXPECT_THAT(files->keep(first).error(), HasSubstr(options.state));
  EXPECT_THAT(files->lead_to({{1}}).error(), HasSubstr(options.state));
}

TEST_F(NetworkdFilesTest, RenameADamagedConfirmationAndUseFactoryAddresses) {
  come_with(first);
  ASSERT_TRUE(files->apply(second));
  ASSERT_TRUE(files->keep(second));
  std::ofstream(options.state + "/confirmed.json") << "{\"format\":1,";
  restart(true);
  EXPECT_EQ(files->confirmed_numbers(), first);
  EXPECT_THAT(in(options.state), UnorderedElementsAre("confirmed.json.damaged"));
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", first));
  EXPECT_TRUE(files->apply(second));
}

TEST_F(NetworkdFilesTest, UseFactoryAddressesIfNothingIsReadable) {
  come_with(first);
  fs::create_directory(options.state + "/confirmed.json");
  EXPECT_FALSE(files->settle()) << "the addresses in use must stay";
  EXPECT_THAT(in(options.networkd), IsEmpty());
  ASSERT_TRUE(NetworkdFiles(options, &nobody).write_at_start());
  EXPECT_EQ(text_of("05-adit-team.network"), network::team_file("team0", first));
  folder.put("network.json", "{");
  NetworkdFiles without(options, &nobody);
  EXPECT_TRUE(without.write_at_start());
  EXPECT_EQ(without.confirmed_numbers(), std::nullopt);
}

}  // namespace
}  // namespace adit::applier
