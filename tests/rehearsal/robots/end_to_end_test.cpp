#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <future>
#include <utility>

#include "program.hpp"
#include "project_files.hpp"
#include "rehearsal/robots/cave.hpp"
#include "server.hpp"

namespace adit::robots {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

struct Programs : testing::Test {
  Programs() : folder_(fs::path(testing::TempDir()) / ("adit_robots_" + std::to_string(getpid()))) {
    fs::create_directories(folder_);
    for (const char* name : {"team.token", "scoring.token", "mapping.token"}) {
      std::ofstream(folder_ / name) << "flux230{showroom\n";
    }
  }
  ~Programs() override { fs::remove_all(folder_); }

  std::vector<std::string> robots(std::vector<std::string> more) const {
    std::vector<std::string> arguments = {built_program("adit-robots"), "--secrets", folder_.string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  fs::path folder_;
};

TEST_F(Programs, TruthIsWrittenWithoutARun) {
  const fs::path csv = folder_ / "truth.csv";
  Program program({built_program("adit-robots"), "--generate-only", "--seed", "12", "--truth", csv.string()});
  EXPECT_EQ(program.wait(), 0);
  std::ifstream stream(csv);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(text, Cave::generate(12).truth_csv());
}

/// It would wait five seconds for an answer. On a busy machine its end may take as long now and then.
TEST_F(Programs, UnansweredTeamStopsAtOnceAndTellsSo) {
  Clock::duration took = 1h;
  for (int attempt = 0; attempt < 5 && took > 3s; ++attempt) {
    std::promise<void> arrived;
    const Server silent([&, first = true](int connection) mutable {
      if (std::exchange(first, false)) arrived.set_value();
      char byte = 0;
      while (recv(connection, &byte, 1, 0) == 1) continue;  // until the client goes
    });
    Program program(
        robots({"--post", "http://127.0.0.1:" + std::to_string(silent.address().port), "--quiet"}));
    ASSERT_EQ(arrived.get_future().wait_for(20s), std::future_status::ready);
    const Clock::time_point start = Clock::now();
    program.signal(SIGTERM);
    const std::string summary = program.rest();
    EXPECT_EQ(program.wait(), 1);
    took = Clock::now() - start;
    EXPECT_NE(summary.find("stopped before the answer arrived"), std::string::npos) << summary;
    EXPECT_NE(summary.find("no grid was accepted"), std::string::npos) << summary;
  }
  EXPECT_LT(took, 3s);
}

TEST_F(Programs, UnconnectedTeamFailsAndTellsWhy) {
  Program program(robots({"--post", "http://127.0.0.1:1", "--for", "1", "--quiet"}));
  const std::string summary = program.rest();
  EXPECT_EQ(program.wait(), 1);
  EXPECT_NE(summary.find("state: Connection refused"), std::string::npos) << summary;
}

#ifdef ADIT_REHEARSAL

/// "adit-rehearsal: scoring 127.0.0.1:41234 mapping 127.0.0.1:41235"
std::string url_after(const std::string& line, const std::string& word) {
  const std::size_t at = line.find(word + " ") + word.size() + 1;
  return "http://" + line.substr(at, line.find_first_of(" \n", at) - at);
}

TEST_F(Programs, TeamWorksWithACommandPostAsMeasured) {
  const fs::path csv = folder_ / "truth.csv";
  ASSERT_EQ(Program({built_program("adit-robots"), "--generate-only", "--seed", "2", "--truth", csv.string()})
                .wait(),
            0);
  Program post({built_program("adit-rehearsal"), "--scoring", "127.0.0.1:0", "--mapping", "127.0.0.1:0",
                "--secrets", folder_.string(), "--artifacts", csv.string(), "--as-measured"});
  const std::string line = post.line();
  ASSERT_NE(line.find("mapping"), std::string::npos) << line;
  Program team(robots({"--post", url_after(line, "mapping"), "--scoring", url_after(line, "scoring"),
                       "--style", "cbor", "--seed", "2", "--for", "5"}));
  const std::string said = team.rest();
  EXPECT_EQ(team.wait(), 0) << said;
  EXPECT_NE(said.find("reports: scored +1"), std::string::npos) << said;
  EXPECT_EQ(said.find("rejected:"), std::string::npos) << said;
  post.signal(SIGTERM);
  EXPECT_EQ(post.wait(), 0);
}

TEST_F(Programs, TeamStopsWhenAllIsPosted) {
  Program post({built_program("adit-rehearsal"), "--scoring", "127.0.0.1:0", "--mapping", "127.0.0.1:0",
                "--secrets", folder_.string(), "--control", "127.0.0.1:0", "--as-measured"});
  const std::string line = post.line();
  ASSERT_NE(line.find("mapping"), std::string::npos) << line;
  Program team(
      robots({"--post", url_after(line, "mapping"), "--scoring", url_after(line, "scoring"), "--control",
              url_after(line, "control"), "--style", "json-base64", "--robots", "1", "--stop-when-posted"}));
  const std::string said = team.rest();
  EXPECT_EQ(team.wait(), 0) << said;
  EXPECT_NE(said.find("  r1         cloud"), std::string::npos) << said;
  EXPECT_NE(said.find("  r1         grid"), std::string::npos) << said;
  EXPECT_NE(said.find(" 100.0%"), std::string::npos) << said;
}

#endif

}  // namespace
}  // namespace adit::robots
