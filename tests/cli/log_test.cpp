#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "cli/run_adit.hpp"
#include "cli/view.hpp"
#include "host/folder.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

const std::string kPage =
    R"({"last":8,"records":[{"seq":7,"at":1566309785,"level":"info","message":"listening","fields":{"at":"a"}},)"
    R"({"seq":8,"at":1566309786,"level":"error","message":"no\nline","fields":{}}]})";

TEST(Log, IsPrintedWithItsFields) {
  const Server server({{"GET /adit/log?since=0", Server::ok(kPage)}});
  EXPECT_EQ(run_adit(server, {"log"}).out,
            "2019-08-20T14:03:05.000Z info: listening at=a\n"
            "2019-08-20T14:03:06.000Z error: no\\x0aline\n");
  EXPECT_THAT(run_adit(server, {"log", "--json"}).out, HasSubstr("{\"seq\":8,"));
}

TEST(Log, IsFilteredByAdit) {
  const Server server({{"GET /adit/log?since=0&level=warning&text=a%20%26b", Server::ok(kPage)}});
  EXPECT_EQ(run_adit(server, {"log", "--level", "warning", "--text", "a &b"}).exit, Exit::Fine);
}

TEST(Bundle, IsWrittenToAFile) {
  const host::Folder folder;
  const Server server({{"GET /adit/bundle", Server::ok("packed")}});
  const std::string file = folder.path() + "/box.tar.gz";
  EXPECT_EQ(run_adit(server, {"bundle", file}).out,
            "wrote the support bundle to " + file + " (6 B; without tokens and passwords)\n");
  std::ifstream stream(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(stream), {}), "packed");
  EXPECT_EQ(run_adit(server, {"bundle", "/none/box.tar.gz"}).err,
            "adit: /none/box.tar.gz: cannot be written\n");
}

TEST(Alarms, AreListedWithTheirIdsAndAcknowledged) {
  api::RunView view = sample_view();
  view.alarms = {{.id = "robot_silent:r1",
                  .severity = alarms::Severity::Bad,
                  .subject = "r1",
                  .since = 940,
                  .what = "r1 is silent",
                  .why = "for 3 min",
                  .details = "for 3 min, after 12 maps"}};
  const Server server(
      {{"GET /adit/run", Server::ok(codec::to_json(view))},
       {"POST /adit/alarms/acknowledge", Server::ok(R"({"acknowledged":"robot_silent:r1"})")}});
  const Outcome outcome = run_adit(server, {"alarms"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.out,
            "r1 is silent: for 3 min\n"
            "  since 1970-01-01T00:15:40.000Z, id robot_silent:r1\n"
            "  for 3 min, after 12 maps\n");
  EXPECT_EQ(run_adit(server, {"alarms", "acknowledge", "robot_silent:r1"}).exit, Exit::Fine);
  EXPECT_THAT(server.posted(), testing::EndsWith(R"({"id":"robot_silent:r1"})"));
}

TEST(Version, OfTheBoxIsShownBesideItsOwn) {
  const Server server(
      {{"GET /adit/about", Server::ok(R"({"version":"0.9.1","build":"9f1c2ab","licence":"","started":0,)"
                                      R"("uptime":90,"kernel":"6.1","model":"","board":null,"parts":[]})")}});
  EXPECT_THAT(run_adit(server, {"version"}).out, HasSubstr("  box       0.9.1\n  build     9f1c2ab\n"));
}

TEST(Version, OfTheProgramIsShownIfTheBoxCannotBeAsked) {
  const Outcome outcome = run_adit(Server(Server::Answers{}), {"version"});
  EXPECT_THAT(outcome.out, testing::StartsWith("adit "));
  EXPECT_NE(outcome.err, "");
  EXPECT_NE(outcome.exit, Exit::Fine);
}

}  // namespace
}  // namespace adit::cli
