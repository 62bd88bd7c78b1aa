#include <gmock/gmock.h>

#include <filesystem>

#include "api/kept_runs.hpp"
#include "cli/run_adit.hpp"
#include "cli/view.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

api::RunRow course_b() {
  return {.key = "1-2",
          .run = 1,
          .id = "beta",
          .course = "B",
          .post = "10.100.2.200:8000",
          .team = "cave",
          .began = 1566309785.5,
          .last = 1566313385,
          .score = 7,
          .remaining_reports = 18,
          .robots = {"r1", "r2"},
          .bytes = 3400000};
}

api::RunList two_kept_runs() {
  return {.runs = {{.key = "2", .run = 2, .post = "10.100.1.200:8000", .is_present = true}, course_b()},
          .bytes = 3400000,
          .trouble = ""};
}

TEST(PresentRun, IsShown) {
  api::RunView view = sample_view();
  view.run_number = 2;
  view.run_id = "beta";
  const auto shown = [&](bool json) {
    const Server server({{"GET /adit/run", Server::ok(codec::to_json(view))}});
    return run_adit(server, json ? std::vector<std::string_view>{"run", "--json"}
                                 : std::vector<std::string_view>{"run"})
        .out;
  };
  EXPECT_EQ(shown(false),
            "  run           2\n"
            "  name          beta\n"
            "  team          cave_club\n"
            "  clock         12:34\n"
            "  score         7\n"
            "  reports left  18\n");
  EXPECT_EQ(shown(true),
            R"({"run":2,"name":"beta","team":"cave_club","run_clock":754.5,"score":7,"remaining_reports":18})"
            "\n");
  view.run.reset();
  EXPECT_THAT(shown(false), testing::EndsWith("no status from the Command Post yet\n"));
}

class Runs : public testing::Test {
 protected:
  Outcome run_adit(std::vector<std::string_view> words, const Console& console = {}) const {
    words.insert(words.begin(), "runs");
    return cli::run_adit(server_, words, console);
  }

  const Server server_{
      {{"GET /adit/runs", Server::ok(codec::to_json(two_kept_runs()))},
       {"GET /adit/runs/1-2", Server::ok(codec::to_json(course_b()))},
       {"GET /adit/runs/7", Server::reply("404 Not Found", "\"there is no such run\"")},
       {"GET /adit/runs/1-2/report.html", Server::ok("<!doctype html><title>Run 1</title>")},
       {"POST /adit/runs/1-2/delete", Server::ok(R"({"key":"1-2"})")},
       {"POST /adit/runs/2/delete", Server::reply("409 Conflict", "\"run 2 is the present one\"")}}};
  host::Folder folder_;
};

TEST_F(Runs, AreListedLatestFirst) {
  const Outcome listed = run_adit({});
  EXPECT_EQ(listed.exit, Exit::Fine);
  EXPECT_THAT(
      listed.out,
      HasSubstr("  1-2  2019-08-20T14:03:05.500Z  B                      7            18       2  3.4 MB\n"));
  EXPECT_THAT(listed.out, testing::ContainsRegex("\n +2 .*10.100.1.200:8000 .* now\n"));
  EXPECT_THAT(listed.out, Not(HasSubstr("1970"))) << "a run with an unknown begin";
  EXPECT_EQ(run_adit({"--json"}).out, codec::to_json(two_kept_runs()) + '\n');
}

TEST_F(Runs, AreShownOneByOne) {
  const Outcome shown = run_adit({"show", "1-2"});
  EXPECT_THAT(shown.out, HasSubstr("robots        r1, r2\n"));
  EXPECT_THAT(shown.out, HasSubstr("reports left  18\n"));
  EXPECT_EQ(run_adit({"show", "1-2", "--json"}).out, codec::to_json(course_b()) + '\n');
  const Outcome none = run_adit({"show", "7"});
  EXPECT_EQ(none.err, "adit: there is no such run\n");
  EXPECT_EQ(none.exit, Exit::Attention);
  EXPECT_EQ(run_adit({"show", "../settings"}).err, "adit: there is no run ../settings: see adit runs\n");
  EXPECT_THAT(run_adit({"show"}).err, StartsWith("adit: a run's key is missing after show\n"));
}

TEST_F(Runs, HaveAReportForScreenOrFile) {
  EXPECT_EQ(run_adit({"report", "1-2"}).out, "<!doctype html><title>Run 1</title>");
  const std::string to = folder_ / "run.html";
  EXPECT_EQ(run_adit({"report", "1-2", "--to", to}).out, "wrote the report of run 1-2 to " + to + "\n");
  EXPECT_EQ(host::read_file(to).value(), "<!doctype html><title>Run 1</title>");
  EXPECT_EQ(run_adit({"report", "1-2", "--to", to, "--json"}).out,
            R"({"key":"1-2","file":")" + to + R"(","bytes":35})" + "\n");
  const Outcome nowhere = run_adit({"report", "1-2", "--to", folder_ / "none/run.html"});
  EXPECT_THAT(nowhere.err, HasSubstr("none/run.html: cannot be written"));
  EXPECT_EQ(nowhere.exit, Exit::Unable);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "none"));
}

TEST_F(Runs, AreDeletedOnlyIfConfirmed) {
  std::string asked;
  const Outcome kept = run_adit({"delete", "1-2"}, answering(false, asked));
  EXPECT_EQ(
      asked,
      "run 1-2 (began 2019-08-20T14:03:05.500Z, score 7, 3.4 MB): its map, tracks and plots will be deleted "
      "for good; its reports stay in the ledger.\nDelete it?");
  EXPECT_EQ(kept.err, "adit: run 1-2 was not deleted\n");
  EXPECT_EQ(kept.exit, Exit::Attention);
  EXPECT_THAT(server_.request(), StartsWith("GET ")) << "a POST was sent";

  const Outcome nobody = run_adit({"delete", "1-2"});
  EXPECT_THAT(nobody.err, HasSubstr("It was not done; to do it, add --yes"));
  EXPECT_THAT(server_.request(), StartsWith("GET "));

  EXPECT_EQ(run_adit({"delete", "1-2"}, answering(true, asked)).out, "run 1-2 was deleted\n");
  EXPECT_EQ(run_adit({"delete", "1-2", "--yes", "--json"}).out, "{\"key\":\"1-2\"}\n");
  const Outcome present = run_adit({"delete", "2", "--yes"});
  EXPECT_EQ(present.err, "adit: run 2 is the present one\n");
  EXPECT_EQ(present.exit, Exit::Attention);
  EXPECT_THAT(run_adit({"show", "1-2", "--yes"}).err, HasSubstr("runs show does not take --yes"));
}

}  // namespace
}  // namespace adit::cli
