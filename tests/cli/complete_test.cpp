#include <gmock/gmock.h>

#include "api/kept_runs.hpp"
#include "api/settings_rows.hpp"
#include "cli/run_adit.hpp"
#include "cli/view.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

class Completion : public testing::Test {
 protected:
  static Server::Answers answers() {
    api::RunView view = sample_view();
    std::vector<facts::ReportRow> reports(3, view.reports.front());
    for (std::size_t i = 0; i < reports.size(); ++i) reports[i].number = static_cast<std::int64_t>(i) + 3;
    reports[1].state = "in_doubt";
    reports[2].state = "held";
    reports[2].type = "Cell\nPhone";
    facts::RejectedRow cloud, state;
    cloud.number = 8;
    cloud.kind = "cloud";
    cloud.robot = "r2";
    state.number = 9;
    state.kind = "state";
    view.rejected = {cloud, state};
    api::RunList runs;
    runs.runs = {{.key = "2", .is_present = true}, {.key = "$HOME"}};
    return {{"GET /adit/reports", Server::ok(codec::to_json(reports))},
            {"GET /adit/run", Server::ok(codec::to_json(view))},
            {"GET /adit/runs", Server::ok(codec::to_json(runs))},
            {"GET /adit/settings",
             Server::ok(setup_json(
                 R"({"version":1,"command_post":{"scoring":{"address":"10.100.1.200","port":8000},)"
                 R"("mapping":{"address":"10.100.1.201","port":8000}},)"
                 R"("team":{"listen":[{"address":"10.0.0.1","port":8000}]},)"
                 R"("courses":[{"name":"B","scoring":{"address":"10.100.2.200","port":8000},)"
                 R"("mapping":{"address":"10.100.2.201","port":8000}}]})"))}};
  }

  Outcome listed(std::vector<std::string_view> words) const {
    words.insert(words.begin(), "complete");
    return run_adit(server_, words);
  }

  Server server_{answers()};
};

TEST_F(Completion, ListsReportsThatAllowAnAction) {
  EXPECT_EQ(listed({"reports"}).out,
            "3\tSurvivor, answered\n4\tSurvivor, in doubt\n5\tCell\\x0aPhone, held\n");
  EXPECT_EQ(listed({"reports", "show"}).out, listed({"reports"}).out);
  EXPECT_EQ(listed({"reports", "settle"}).out, "4\tSurvivor, in doubt\n");
  EXPECT_EQ(listed({"reports", "resubmit"}).out, "3\tSurvivor, answered\n");
  EXPECT_EQ(listed({"reports", "send"}).out, "4\tSurvivor, in doubt\n5\tCell\\x0aPhone, held\n");
  EXPECT_EQ(listed({"reports", "settle", "--json"}).out,
            "[{\"word\":\"4\",\"what\":\"Survivor, in doubt\"}]\n");
}

TEST_F(Completion, ListsRejectedMessagesCoursesAndRuns) {
  EXPECT_EQ(listed({"rejected"}).out, "8\tcloud of r2\n9\tstate\n");
  EXPECT_EQ(listed({"courses"}).out, "B\t10.100.2.200\n");
  EXPECT_EQ(listed({"runs"}).out, "2\tthe present run\n") << "no completion that a shell would execute";
}

TEST(CompletionOfKeys, SendsNoRequest) {
  const Outcome lines = run(std::vector<std::string_view>{"complete", "keys"});
  const auto keys = settings::keys();
  const auto review = std::ranges::find(keys, "reports.review", &settings::Key::path);
  const std::string meaning = review->meaning.substr(0, review->meaning.find_first_of(".:;"));
  EXPECT_THAT(lines.out, HasSubstr("reports.review\t" + meaning + "\n"));
  EXPECT_THAT(lines.out, HasSubstr("robots[].alias\t"));
  const Outcome json = run(std::vector<std::string_view>{"complete", "keys", "--json"});
  EXPECT_EQ(json.out, codec::to_json(keys) + "\n");
}

TEST(CompletionOfKeys, ListsTheValuesOfOne) {
  const auto listed = [](const char* key) {
    return run(std::vector<std::string_view>{"complete", "keys", key}).out;
  };
  EXPECT_EQ(listed("reports.review"), "off\tthe default\nduplicates\t\nall\t\n");
  EXPECT_EQ(listed("team.require_token"), "true\tthe default\nfalse\t\n");
  EXPECT_THAT(listed("reports.near_metres"), testing::StartsWith("5.0\tthe default; allowed: "));
  EXPECT_THAT(listed("robots[ugv1].clouds"), HasSubstr("auto\t"));
}

TEST(CompletionOfReports, IsEmptyWithoutAdit) {
  TokenFile token;
  std::string at;
  {
    at = Server("").at();
  }
  const Outcome outcome =
      run(std::vector<std::string_view>{"complete", "reports", "--at", at, "--token-file", token.path()});
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(outcome.exit, Exit::Unable);
}

}  // namespace
}  // namespace adit::cli
