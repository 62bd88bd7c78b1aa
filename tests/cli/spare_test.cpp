#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "cli/run_adit.hpp"
#include "host/folder.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;

constexpr const char* kAtWork =
    R"({"standby":false,"why":"","since":null,"code":"","asks_code":false,"taken_in":null,"takes_over":false})";
constexpr const char* kStandby =
    R"({"standby":true,"why":"its spare takes over","since":1.75e9,"code":"1234 5678 9012 3456","asks_code":false,)"
    R"("taken_in":null,"takes_over":false})";
constexpr const char* kTakenIn =
    R"({"standby":false,"why":"","since":null,"code":"","asks_code":false,"taken_in":{"name":"10.0.0.1",)"
    R"("version":"1.2.3","at":1.75e9,"reports":4,"open":1,"post":"10.100.1.200:8000","run":{"score":3,)"
    R"("run_clock":100,"remaining_reports":20,"current_team":"adit"},"port":8000,"left_out":["later"]},"takes_over":false})";

constexpr const char* kStick =
    R"({"standby":false,"why":"","since":null,"code":"","asks_code":false,"taken_in":null,"takes_over":false,)"
    R"("stick":{"hindrance":"","unreadable":"","doing":"","refusal":"","written":"","exports":[)"
    R"({"name":"adit-a.adit-spare","box":"","at":null},{"name":"adit-b.adit-spare","box":"","at":null}]}})";
constexpr const char* kNoStick =
    R"({"standby":false,"why":"","since":null,"code":"","asks_code":false,"taken_in":null,"takes_over":false,)"
    R"("stick":{"hindrance":"there is no stick in the box","unreadable":"","doing":"","refusal":"","written":"","exports":[]}})";

constexpr const char* kUnreadableStick =
    R"({"standby":false,"why":"","since":null,"code":"","asks_code":false,"taken_in":null,"takes_over":false,)"
    R"("stick":{"hindrance":"","unreadable":"cannot read the stick sda1: Input/output error","doing":"","refusal":"",)"
    R"("written":"","exports":[]}})";

class SpareCommand : public testing::Test {
 protected:
  Outcome run_adit(const Server& server, std::vector<std::string_view> words) const {
    words.insert(words.begin(), "spare");
    return cli::run_adit(server, words);
  }
  const host::Folder folder_;
  const std::string export_ = folder_ / "box.adit-spare";
};

TEST_F(SpareCommand, ShowsTheStateOfTheBox) {
  const Server at_work({{"GET /adit/spare", Server::ok(kAtWork)}});
  EXPECT_EQ(run_adit(at_work, {}).exit, Exit::Fine);
  const Server standby({{"GET /adit/spare", Server::ok(kStandby)}});
  const Outcome outcome = run_adit(standby, {"show"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_EQ(outcome.out,
            "This box is on standby: its spare takes over\nCode of its export: 1234 5678 9012 3456\n");
}

TEST_F(SpareCommand, NeedsConfirmationForStandby) {
  const Server server({{"GET /adit/spare", Server::ok(kAtWork)}});
  const Outcome outcome = run_adit(server, {"export", export_});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_THAT(outcome.err, HasSubstr("It was not done; to do it, add --yes"));
}

TEST_F(SpareCommand, WritesTheExportAndShowsItsCode) {
  const Server server({{"POST /adit/spare/standby", Server::ok(kAtWork)},
                       {"GET /adit/spare/export", Server::ok("a sealed file")},
                       {"GET /adit/spare", Server::ok(kStandby)}});
  const Outcome outcome = run_adit(server, {"export", export_, "--yes"});
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("Code of its export: 1234 5678 9012 3456\n"));
  std::ifstream file(export_, std::ios::binary);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(file), {}), "a sealed file");
}

TEST_F(SpareCommand, RejectsAnInvalidExportBeforeSending) {
  const Server server(Server::Answers{});
  const std::string other = folder_.put("other", "PK a zip file of more bytes");
  EXPECT_THAT(run_adit(server, {"take", other, "--code", "1234567890123456"}).err,
              HasSubstr("the file is not an export from Adit"));
  EXPECT_THAT(run_adit(server, {"take", folder_ / "none", "--code", "1"}).err,
              HasSubstr("none: cannot be read"));
  EXPECT_THAT(run_adit(server, {"take", other}).err,
              HasSubstr("the code of the export is missing: give --code"));
}

TEST_F(SpareCommand, StaysInServiceIfTheStickCannotBeWritten) {
  const Server without({{"GET /adit/spare", Server::ok(kNoStick)}});
  const Outcome outcome = run_adit(without, {"export", "--stick", "--yes"});
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_THAT(outcome.err, HasSubstr("the box was not put on standby: there is no stick in the box"));
  const Server pc({{"GET /adit/spare", Server::ok(kAtWork)}});
  EXPECT_THAT(run_adit(pc, {"export", "--stick", "--yes"}).err, HasSubstr("cannot use a stick"));
}

TEST_F(SpareCommand, TellsWhyTheStickCannotBeRead) {
  const Server server({{"GET /adit/spare", Server::ok(kUnreadableStick)}});
  const std::string why = "cannot read the stick sda1: Input/output error";
  EXPECT_THAT(run_adit(server, {"show"}).out, HasSubstr("The stick: " + why));
  EXPECT_THAT(run_adit(server, {"take", "--stick", "--code", "1234567890123456"}).err, HasSubstr(why));
}

TEST_F(SpareCommand, ListsTheStickAndImportsTheNamedExport) {
  const Server server(
      {{"POST /adit/spare/from-stick", Server::reply("409 Conflict", R"("it cannot be read")")},
       {"GET /adit/spare", Server::ok(kStick)}});
  EXPECT_THAT(run_adit(server, {"show"}).out,
              HasSubstr("On the stick: adit-a.adit-spare\nOn the stick: adit-b"));
  EXPECT_THAT(run_adit(server, {"take", "--stick", "--code", "1234567890123456"}).err,
              HasSubstr("the stick has several exports: name one of adit-a.adit-spare adit-b.adit-spare"));
  EXPECT_THAT(run_adit(server, {"take", "adit-b.adit-spare", "--stick", "--code", "1234567890123456"}).err,
              HasSubstr("it cannot be read"));
}

TEST_F(SpareCommand, AcceptsAFileOrTheStick) {
  const Server server(Server::Answers{});
  EXPECT_THAT(run_adit(server, {"export"}).err, HasSubstr("a file or --stick is missing after export"));
  EXPECT_THAT(run_adit(server, {"take"}).err, HasSubstr("a file or --stick is missing after take"));
  EXPECT_THAT(run_adit(server, {"export", "x", "--stick"}).err, HasSubstr("give FILE or --stick, not both"));
  EXPECT_THAT(run_adit(server, {"resume", "--stick"}).err, HasSubstr("spare resume does not take --stick"));
}

TEST_F(SpareCommand, ShowsTheExportAndTakesOverOnlyIfConfirmed) {
  const std::string file = folder_.put("it", std::string("adit-spare\1\0 and more", 21));
  const Server server({{"POST /adit/spare/take-over", Server::ok(kAtWork)},
                       {"POST /adit/spare/take", Server::ok(kAtWork)},
                       {"POST /adit/spare/open", Server::ok(kTakenIn)},
                       {"GET /adit/spare", Server::ok(kTakenIn)}});
  const Outcome unasked = run_adit(server, {"take", file, "--code", "1234567890123456"});
  EXPECT_EQ(unasked.exit, Exit::Attention);
  EXPECT_THAT(unasked.err, HasSubstr("reports may be sent twice"));
  const Outcome meant = run_adit(server, {"take", file, "--code", "1234567890123456", "--yes"});
  EXPECT_EQ(meant.exit, Exit::Fine) << meant.err;
  EXPECT_THAT(meant.out, HasSubstr("team's port 8000, at this box after the take-over"));
  EXPECT_THAT(meant.out, HasSubstr("this box is taking over"));
  EXPECT_THAT(run_adit(server, {"show"}).out, HasSubstr("4 reports, 1 of them unfinished"));
}

}  // namespace
}  // namespace adit::cli
