#include "applier/applier.hpp"

#include <gmock/gmock.h>
#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

#include "host/folder.hpp"
#include "network/doubles.hpp"

namespace adit::applier {
namespace {

namespace fs = std::filesystem;
constexpr const char* kNonce = "0123456789abcdef0123456789abcdef";
/// Fails while a file "broken" exists. A file with a decision appears while it runs.
constexpr const char* kNetworkctl = R"(
ls wanted state >seen
test ! -e broken || exit 1
printf 1 >>reloads
test ! -e word || { sleep 0.2; mv word wanted/word.json; sleep 1.2; }
)";

class ApplierTest : public testing::Test {
 protected:
  ApplierTest() {
    for (const char* name : {"wanted", "status", "state", "networkd"}) fs::create_directory(folder / name);
    options.wanted = folder / "wanted";
    options.status = folder / "status";
    options.state = folder / "state";
    options.networkd = folder / "networkd";
    options.factory = folder / "factory.json";
    options.networkctl = folder.put("networkctl", "#!/bin/sh\ncd " + folder.path() + kNetworkctl, 0700);
  }
  /// One process, from its start to its kill.
  struct Life {
    explicit Life(const Options& options) : applier(loop, options), started(applier.start()) {}
    loop::Loop loop;
    Applier applier;
    std::expected<void, std::string> started;
  };
  /// Whether adit-network exits with success.
  bool runs_well() {
    Life life(options);
    EXPECT_TRUE(life.started) << life.started.error();
    life.loop.run();
    return life.applier.is_done();
  }
  /// Writes a request as aditd does.
  template <class Request>
  void ask(const char* file, const Request& request) {
    fs::rename(folder.put("new", codec::write_file(request)), options.wanted + '/' + file);
  }
  void request_change(std::chrono::milliseconds within = std::chrono::minutes(1)) {
    ask(network::kWantedFile, network::ChangeRequest{kNonce, within, tried});
  }
  void break_networkd() { folder.put("broken", ""); }
  void mend_networkd() { fs::remove(folder / "broken"); }
  network::Status status() const {
    std::ifstream file(options.status + '/' + host::kStatusFile);
    const auto status =
        codec::read_file<network::Status>(std::string{std::istreambuf_iterator<char>(file), {}});
    EXPECT_TRUE(status) << status.error();
    return status.value_or(network::Status{});
  }
  /// How often networkd has read its files.
  std::size_t reloads() const {
    return fs::exists(folder / "reloads") ? fs::file_size(folder / "reloads") : 0;
  }
  /// The content of the directories when networkd was told of a change.
  std::string seen() const {
    std::ifstream file(folder / "seen");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  host::Folder folder;
  Options options;
  const network::Numbers kept = network::numbers("192.168.7.11/24", "10.100.1.10/24", "10.100.1.1"),
                         tried = network::numbers("192.168.8.11/24", "10.100.1.10/24", "10.100.1.1");
  const network::Endpoints by_gateway{{0x0a6402c8}};
};

TEST_F(ApplierTest, DeletesAForgetRequestOnceDone) {
  folder.put("state/confirmed.json", network::write_kept(network::numbers()));
  EXPECT_TRUE(runs_well());
  folder.put("wanted/forget.json", codec::write_file(network::FactoryRequest{kNonce}));
  EXPECT_TRUE(runs_well());
  EXPECT_EQ(seen(), "state:\n\nwanted:\nforget.json\n")
      << "the request must be removed only after its effect is on disk";
  EXPECT_TRUE(fs::is_empty(options.wanted));
}

TEST_F(ApplierTest, DeletesAnInvalidForgetRequest) {
  folder.put("state/confirmed.json", network::write_kept(network::numbers()));
  for (const std::string text : {"", "{}", "[]"}) {
    folder.put("wanted/forget.json", text);
    EXPECT_TRUE(runs_well());
    EXPECT_TRUE(fs::is_empty(options.wanted)) << text;
  }
  fs::create_directory(options.wanted + "/forget.json");
  EXPECT_TRUE(runs_well());
  EXPECT_TRUE(fs::is_empty(options.wanted));
  EXPECT_TRUE(fs::exists(options.state + "/confirmed.json"));
}

TEST_F(ApplierTest, TellsWhyItCannotWork) {
  request_change();
  fs::create_directory(options.state + "/confirmed.json");
  EXPECT_FALSE(Life(options).started);
  EXPECT_THAT(status().trouble, testing::HasSubstr("confirmed.json: is not a regular file"));
  EXPECT_EQ(status().team_interface, options.team);
  fs::remove(options.state + "/confirmed.json");
  EXPECT_TRUE(runs_well());
  EXPECT_EQ(status().trouble, "");
  EXPECT_TRUE(fs::is_empty(options.wanted)) << "a request of an earlier boot is dropped";
}

TEST_F(ApplierTest, ReportsARequestThatCannotBeDeleted) {
  fs::create_directory(options.wanted + "/word.json");
  const pid_t child = fork();
  if (child == 0) {  // a mount point cannot be removed
    const int own = geteuid() == 0 ? CLONE_NEWNS : CLONE_NEWUSER | CLONE_NEWNS;
    const bool mounted = unshare(own) == 0 && mount("", "/", "", MS_REC | MS_PRIVATE, "") == 0 &&
                         mount("none", (options.wanted + "/word.json").c_str(), "tmpfs", 0, "") == 0;
    _exit(!mounted ? 77 : runs_well() ? 1 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "needs to mount";
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(runs_well()) << "once the file can be removed";
}

TEST_F(ApplierTest, ReportsAFailedAddressProbe) {
  options.team = options.command_post = "none0";
  EXPECT_TRUE(runs_well());
  ask(network::kProbeFile, network::Probe{kNonce, "10.100.1.200"});
  EXPECT_TRUE(runs_well());
  const auto probed = host::read_row<network::ProbeResult>(options.status + '/' + network::kProbedFile);
  ASSERT_TRUE(probed && *probed);
  EXPECT_EQ((*probed)->found_on, "");
  EXPECT_THAT((*probed)->not_sought, testing::StartsWith("none0: "));
}

TEST_F(ApplierTest, AcceptsAConfirmationThatCameWhileBusy) {
  EXPECT_TRUE(runs_well());
  request_change(network::kLeastWithin);
  Life life(options);
  ASSERT_TRUE(status().pending);
  folder.put("word", codec::write_file(network::Decision{kNonce, network::Decision::Command::Confirm}));
  ask(network::kEndpointsFile, by_gateway);
  life.loop.run();
  EXPECT_EQ(status().ended, network::ChangeOutcome::Confirmed) << status().why;
  EXPECT_EQ(status().kept, tried);
}

TEST_F(ApplierTest, AcceptsAConfirmationThatCameBeforeStop) {
  EXPECT_TRUE(runs_well());
  request_change();
  Life life(options);
  ask(network::kWordFile, network::Decision{kNonce, network::Decision::Command::Confirm});
  life.applier.stop();
  EXPECT_EQ(status().ended, network::ChangeOutcome::Confirmed);
}

class NetworkdFailureTest : public ApplierTest {
 protected:
  NetworkdFailureTest() {
    folder.put("state/confirmed.json", network::write_kept(kept));
    EXPECT_TRUE(runs_well());
    before = reloads();
  }
  /// Checks that the next start reloads networkd, once.
  void expect_reload_by_the_next_start() {
    const std::size_t failed = reloads();
    mend_networkd();
    EXPECT_TRUE(runs_well());
    EXPECT_EQ(reloads(), failed + 1);
    EXPECT_TRUE(runs_well());
    EXPECT_EQ(reloads(), failed + 1);
  }
  std::size_t before = 0;
};

TEST_F(NetworkdFailureTest, WhileAChangeIsRevertedAfterAKill) {
  request_change();
  EXPECT_TRUE(Life(options).started);
  break_networkd();
  EXPECT_FALSE(Life(options).started);
  EXPECT_TRUE(status().pending) << "the change is still in use";
  mend_networkd();
  EXPECT_TRUE(runs_well());
  EXPECT_EQ(reloads(), before + 2);
  EXPECT_EQ(status().ended, network::ChangeOutcome::Reverted);
  EXPECT_FALSE(status().pending);
}

TEST_F(NetworkdFailureTest, WhileAChangeIsRevertedBeforeAStop) {
  request_change();
  {
    Life life(options);
    break_networkd();
    ask(network::kWordFile, network::Decision{kNonce, network::Decision::Command::Revert});
    life.loop.turn(std::chrono::seconds(5));
    EXPECT_TRUE(status().pending);
    life.applier.stop();
    EXPECT_FALSE(life.applier.is_done());
    EXPECT_TRUE(status().pending);
  }
  expect_reload_by_the_next_start();
}

TEST_F(NetworkdFailureTest, WhileRoutesChange) {
  break_networkd();
  ask(network::kEndpointsFile, by_gateway);
  EXPECT_FALSE(runs_well());
  EXPECT_EQ(status().endpoints, network::Endpoints{}) << "aditd repeats the request";
  expect_reload_by_the_next_start();
  EXPECT_EQ(status().endpoints, by_gateway);
}

TEST_F(NetworkdFailureTest, WhileRoutesChangeDuringAPendingChange) {
  request_change();
  Life life(options);
  break_networkd();
  ask(network::kEndpointsFile, by_gateway);
  life.loop.turn(std::chrono::seconds(5));
  EXPECT_EQ(status().endpoints, network::Endpoints{});
  mend_networkd();
  ask(network::kEndpointsFile, by_gateway);
  life.loop.turn(std::chrono::seconds(5));
  EXPECT_EQ(status().endpoints, by_gateway);
  EXPECT_EQ(reloads(), before + 2);
}

TEST_F(NetworkdFailureTest, WhileAllIsForgotten) {
  break_networkd();
  ask(network::kForgetFile, network::FactoryRequest{kNonce});
  EXPECT_FALSE(runs_well());
  EXPECT_FALSE(Life(options).started);
  EXPECT_EQ(status().kept, kept) << "the addresses are still in use";
  mend_networkd();
  EXPECT_TRUE(runs_well());
  EXPECT_GT(reloads(), before);
  EXPECT_EQ(status().kept, std::nullopt);
  EXPECT_TRUE(fs::is_empty(options.wanted));
}

}  // namespace
}  // namespace adit::applier
