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

class ApplierTest : public testing::Test {
 protected:
  ApplierTest() {
    for (const char* name : {"wanted", "status", "state", "networkd"}) fs::create_directory(folder / name);
    options.wanted = folder / "wanted";
    options.status = folder / "status";
    options.state = folder / "state";
    options.networkd = folder / "networkd";
    options.factory = folder / "factory.json";
    options.networkctl =
        folder.put("networkctl", "#!/bin/sh\ncd " + folder.path() + "\nls wanted state >seen\n", 0700);
  }
  /// adit-network's exit status, more or less.
  bool runs_well() {
    loop::Loop loop;
    Applier applier(loop, options);
    const auto started = applier.start();
    EXPECT_TRUE(started) << started.error();
    loop.run();
    return !applier.is_stuck();
  }
  /// What was in the folders when networkd was told of a change.
  std::string seen() const {
    std::ifstream file(folder / "seen");
    return {std::istreambuf_iterator<char>(file), {}};
  }

  host::Folder folder;
  Options options;
};

TEST_F(ApplierTest, TakesAwayThatItIsToForgetOnceItHasForgotten) {
  folder.put("state/confirmed.json", network::write_kept(network::numbers()));
  EXPECT_TRUE(runs_well());
  folder.put("wanted/forget.json", network::write(network::Forget{kNonce}));
  EXPECT_TRUE(runs_well());
  EXPECT_EQ(seen(), "state:\n\nwanted:\nforget.json\n") << "a power cut now would lose it";
  EXPECT_TRUE(fs::is_empty(options.wanted));
}

TEST_F(ApplierTest, TakesAwayARequestToForgetThatIsNone) {
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

TEST_F(ApplierTest, SaysWhereARequestCannotBeTakenAway) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root";
  fs::create_directory(options.wanted + "/word.json");
  const pid_t child = fork();
  if (child == 0) {  // what is mounted on cannot be taken away
    const bool mounted = unshare(CLONE_NEWNS) == 0 && mount("", "/", "", MS_REC | MS_PRIVATE, "") == 0 &&
                         mount("none", (options.wanted + "/word.json").c_str(), "tmpfs", 0, "") == 0;
    _exit(!mounted ? 77 : runs_well() ? 1 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "needs to mount";
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_TRUE(runs_well()) << "once it can be";
}

}  // namespace
}  // namespace adit::applier
