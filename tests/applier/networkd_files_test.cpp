#include "applier/networkd_files.hpp"

#include <gmock/gmock.h>

#include "host/folder.hpp"
#include "network/doubles.hpp"
#include "network/networkd.hpp"

namespace adit::applier {
namespace {

namespace fs = std::filesystem;
using network::numbers;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::expected<std::optional<Claim>, std::string> nobody(const std::string& interface, std::uint32_t) {
  if (interface == "darpa0") return std::unexpected("darpa0: Network is down");
  return std::nullopt;
}
std::expected<std::optional<Claim>, std::string> somebody(const std::string& interface,
                                                          std::uint32_t address) {
  if (interface == "darpa0" || address != *settings::ipv4_of("192.168.8.11")) return std::nullopt;
  return Claim{"02:00:00:00:00:09", ""};
}

class NetworkdFilesTest : public testing::Test {
 protected:
  NetworkdFilesTest() {
    for (const char* name : {"tried", "kept", "state"}) fs::create_directory(folder / name);
    options.tried = folder / "tried";
    options.kept = folder / "kept";
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
  /// As the next start of adit-network would find it, after the machine was started anew or not.
  void start_anew(bool machine) {
    if (machine) fs::remove_all(options.tried), fs::create_directory(options.tried);
    files = std::make_unique<NetworkdFiles>(options, &nobody);
    const auto settled = files->settle();
    EXPECT_TRUE(settled) << settled.error();
  }

  host::Folder folder;
  Options options;
  std::unique_ptr<NetworkdFiles> files = std::make_unique<NetworkdFiles>(options, &nobody);
  const network::Numbers first = numbers(), second = numbers("192.168.8.11/24");
};

TEST_F(NetworkdFilesTest, TryInTheFolderThatIsGoneAtTheNextStart) {
  ASSERT_TRUE(files->settle());
  EXPECT_EQ(reloads(), 0u);
  ASSERT_TRUE(files->apply(first));
  EXPECT_THAT(in(options.tried),
              UnorderedElementsAre("40-adit-team.network", "40-adit-command-post.network"));
  EXPECT_THAT(in(options.kept), IsEmpty());
  EXPECT_EQ(text(options.tried + "/40-adit-team.network"), network::team_file("team0", first));
  EXPECT_EQ(reloads(), 1u);
  ASSERT_TRUE(files->take_back());
  EXPECT_THAT(in(options.tried), IsEmpty());
  EXPECT_EQ(reloads(), 2u);
}

TEST_F(NetworkdFilesTest, KeepWithoutDisturbingAnything) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  EXPECT_THAT(in(options.kept), UnorderedElementsAre("50-adit-team.network", "50-adit-command-post.network"));
  EXPECT_EQ(text(options.kept + "/50-adit-command-post.network"),
            network::command_post_file("darpa0", first));
  EXPECT_EQ(reloads(), 1u) << "networkd has it all already";
  ASSERT_TRUE(files->take_back());
  EXPECT_EQ(reloads(), 1u) << "there is nothing to take back";
}

TEST_F(NetworkdFilesTest, TouchOnlyTheInterfaceThatChanges) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  start_anew(true);
  ASSERT_TRUE(files->apply(second));
  EXPECT_THAT(in(options.tried), UnorderedElementsAre("40-adit-team.network"));
  ASSERT_TRUE(files->take_back());
  EXPECT_THAT(in(options.tried), IsEmpty());
  EXPECT_EQ(text(options.kept + "/50-adit-team.network"), network::team_file("team0", first));
}

TEST_F(NetworkdFilesTest, TakeNoAddressThatSomebodyElseHas) {
  NetworkdFiles watchful(options, &somebody);
  EXPECT_EQ(watchful.apply(second).error(), "192.168.8.11 is in use already on team0, by 02:00:00:00:00:09");
  EXPECT_THAT(in(options.tried), IsEmpty());
  EXPECT_EQ(reloads(), 0u);
  EXPECT_TRUE(watchful.apply(first));
}

TEST_F(NetworkdFilesTest, GoBackToWhatWasConfirmedInThisVeryStart) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  ASSERT_TRUE(files->apply(second));
  ASSERT_TRUE(files->take_back());
  EXPECT_THAT(in(options.tried), UnorderedElementsAre("40-adit-command-post.network"))
      << "it says what is confirmed";
  EXPECT_EQ(text(options.kept + "/50-adit-team.network"), network::team_file("team0", first));
}

TEST_F(NetworkdFilesTest, LoseAnUnconfirmedChangeInAPowerCut) {
  ASSERT_TRUE(files->apply(first));
  start_anew(true);
  EXPECT_FALSE(files->found_a_change());
  EXPECT_EQ(files->confirmed(), std::nullopt);
  EXPECT_THAT(in(options.kept), IsEmpty());
}

TEST_F(NetworkdFilesTest, TakeAnUnconfirmedChangeBackAfterAKill) {
  ASSERT_TRUE(files->apply(first));
  start_anew(false);
  EXPECT_TRUE(files->found_a_change());
  EXPECT_THAT(in(options.tried), IsEmpty());
  EXPECT_EQ(reloads(), 2u);
}

TEST_F(NetworkdFilesTest, FinishAKeepingThatWasCutOff) {
  ASSERT_TRUE(files->apply(second));
  ASSERT_TRUE(files->keep(second));
  std::ofstream(options.kept + "/50-adit-team.network") << network::team_file("team0", first);
  fs::remove(options.kept + "/50-adit-command-post.network");
  start_anew(true);
  EXPECT_EQ(files->confirmed(), second);
  EXPECT_EQ(text(options.kept + "/50-adit-team.network"), network::team_file("team0", second));
  EXPECT_EQ(text(options.kept + "/50-adit-command-post.network"),
            network::command_post_file("darpa0", second));
}

TEST_F(NetworkdFilesTest, SayWhatDidNotWorkAndTryItAgain) {
  folder.put("broken", "");
  EXPECT_THAT(files->apply(first).error(), HasSubstr("networkctl reload: exit status 1"));
  EXPECT_FALSE(files->take_back());
  fs::remove(folder / "broken");
  const std::size_t before = reloads();
  EXPECT_TRUE(files->take_back());
  EXPECT_EQ(reloads(), before + 1) << "though the files are gone already";
  fs::remove_all(options.tried);
  EXPECT_THAT(files->apply(first).error(), HasSubstr(options.tried));
  fs::remove_all(options.state);
  EXPECT_THAT(files->keep(first).error(), HasSubstr(options.state));
}

TEST_F(NetworkdFilesTest, SetADamagedConfirmationAsideAndGoOn) {
  ASSERT_TRUE(files->apply(first));
  ASSERT_TRUE(files->keep(first));
  std::ofstream(options.state + "/confirmed.json") << "{\"version\":1,";
  start_anew(true);
  EXPECT_EQ(files->confirmed(), std::nullopt);
  EXPECT_THAT(in(options.state), UnorderedElementsAre("confirmed.json.damaged"));
  EXPECT_EQ(in(options.kept).size(), 2u) << "networkd goes on as it was";
  EXPECT_TRUE(files->apply(second));
}

}  // namespace
}  // namespace adit::applier
