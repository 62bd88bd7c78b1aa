#include "ledger/ledger.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "cli/run_adit.hpp"
#include "host/folder.hpp"
#include "store/log.hpp"

namespace adit::cli {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
namespace fs = std::filesystem;

class LedgerDump : public testing::Test {
 protected:
  /// With all output.
  Outcome dump(const std::string& directory) const {
    std::string printed;
    const Console console{.print = [&](const std::string& text) { printed += text; }};
    const std::vector<std::string_view> words{"ledger", "dump", directory};
    Outcome outcome = run(words, console);
    outcome.out.insert(0, printed);
    return outcome;
  }
  dispatch::Report report(dispatch::ReportState state) const {
    dispatch::Report report{
        .number = 7, .sender = "10.0.0.5", .received = 10.5, .changed = 11, .state = state};
    report.report = {"Backpack", {1, 2.5, 3}};
    report.before =
        icd::RunStatus{.score = 4, .run_clock = 5, .remaining_reports = 6, .current_team = "ours"};
    return report;
  }

  host::Folder state_;
  const std::string directory_ = state_ / "ledger";
};

TEST_F(LedgerDump, PrintsAllMembersEvenWhileAditRuns) {
  auto ledger = ledger::Ledger::open(state_.path());
  const std::vector<dispatch::Report> steps{report(dispatch::ReportState::Queued),
                                            report(dispatch::ReportState::Sending)};
  const dispatch::Run run{.number = 2, .id = "R", .status_clock = dispatch::Clock{.shows = 8, .runs = true}};
  ASSERT_TRUE(ledger->write(steps, &run));
  const Outcome outcome = dump(directory_);
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_EQ(
      outcome.out,
      R"({"sequence":1,"kind":1,"highest":7,"reports":[{"number":7,"type":"Backpack","x":1.0,"y":2.5,"z":3.0,)"
      R"("robot":"","sender":"10.0.0.5","received":10.5,"changed":11.0,"state":"sending","note":"","run":0,)"
      R"("asked":false,"same_as":0,"tries":0,"sending":0,"sent":0.0,"before":{"score":4,"run_clock":5.0,)"
      R"("remaining_reports":6,"current_team":"ours"},"status":0,"content_type":"","answer":"",)"
      R"("reconciled":false,"beside":0,"counted":false,"uncertain":"","history":[{"at":11.0,"state":"queued","note":""},)"
      R"({"at":11.0,"state":"sending","note":""}]}],"runs":[{"number":2,"id":"R","began":0.0,"why":"",)"
      R"("last":null,"heard":0.0,"post":"","unreliable":"","turn":0,"may_be":0,)"
      R"("status_clock":{"shows":8.0,"runs":true},"answer_clock":null,)"
      R"("signs":{"count":false,"clock":false,"score":false,"name":false},"name_trouble":""}]})"
      "\n");
}

TEST_F(LedgerDump, TellsMissingAndUnknownRecords) {
  {
    const auto directory = store::Directory::lock(directory_);
    store::Log log(*directory, ledger::Ledger::kKeeping);
    ASSERT_TRUE(log.start(*store::Contents::read(*directory, ledger::Ledger::kKeeping)));
    const auto append = [&](std::uint8_t kind) {
      EXPECT_TRUE(log.append(kind, "what nobody knows", store::Durability::Now));
    };
    append(1);
    ASSERT_TRUE(log.turn());
    append(9);
    append(1);
  }
  std::string first;
  for (const auto& file : fs::directory_iterator(directory_))
    if (file.path().filename().string().starts_with("log-00000001")) first = file.path();
  fs::remove(first);
  const Outcome outcome = dump(directory_);
  EXPECT_EQ(outcome.exit, Exit::Attention);
  EXPECT_THAT(outcome.out, StartsWith(R"({"gap":{"first":1,"last":1,"file":"log-00000002)"));
  EXPECT_THAT(outcome.out, EndsWith("{\"sequence\":2,\"kind\":9,\"bytes\":17}\n"
                                    "{\"sequence\":3,\"kind\":1,\"bytes\":17}\n"));
  EXPECT_THAT(outcome.err, HasSubstr("adit: records are missing in log-00000002"));
  EXPECT_THAT(outcome.err, EndsWith("adit: record 3 cannot be understood\n"));
}

TEST_F(LedgerDump, FailsIfAFileCannotBeRead) {
  const auto fails = [&](const std::string& why) {
    const Outcome outcome = dump(directory_);
    EXPECT_EQ(outcome.exit, Exit::Unable);
    EXPECT_EQ(outcome.out, "");
    EXPECT_THAT(outcome.err, HasSubstr(why));
  };
  fails(directory_ + ": No such file or directory");
  fs::create_directory(directory_);
  fails(directory_ + ": there is no ledger");
  fs::create_directory(directory_ + "/log-00000001.0123456789abcdef");
  fails("log-00000001.0123456789abcdef: ");
}

TEST(LedgerNew, NeedsConfirmation) {
  const Server server({{"POST /adit/ledger/new", Server::ok(R"({"kept_as":"ledger.damaged-1"})")}});
  EXPECT_THAT(run_adit(server, {"ledger", "new"}).err,
              HasSubstr("a report may be sent twice. It was not done; to do it, add --yes"));
  EXPECT_EQ(server.posted(), "");
  const Outcome outcome = run_adit(server, {"ledger", "new", "--yes"});
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_EQ(outcome.out, "aditd restarts with another ledger: see adit status\n");
}

}  // namespace
}  // namespace adit::cli
