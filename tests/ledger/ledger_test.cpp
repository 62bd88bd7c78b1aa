#include "ledger/ledger.hpp"

#include <sys/stat.h>

#include "dispatch/reports.hpp"
#include "ledger/state.hpp"

namespace adit::ledger {
namespace {

using dispatch::Flush;
using dispatch::Report;
using dispatch::ReportState;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Ledger, RestoresReportsRunsAndHistories) {
  const State state;
  dispatch::Run first{.number = 1, .began = 5}, second{.number = 2, .id = "1.5", .began = 9};
  Report report = backpack(2);
  std::vector<Report> steps{report};
  for (const ReportState next : {ReportState::Sending, ReportState::InDoubt, ReportState::Settled}) {
    report = in_state(report, next);
    report.note = "now " + std::string(name_of(next));
    report.changed -= 1;  // a clock that was set back does not change the order
    steps.push_back(report);
  }
  const auto check = [&](const Ledger& ledger) {
    EXPECT_EQ(ledger.damage(), "");
    EXPECT_EQ(ledger.refusal(), "");
    EXPECT_THAT(ledger.reports(), ElementsAre(backpack(1), report, backpack(11)));
    EXPECT_THAT(ledger.runs(), ElementsAre(first, second));
    EXPECT_THAT(ledger.history(2),
                ElementsAre(Step{10, "queued", ""}, Step{9, "sending", "now sending"},
                            Step{8, "in_doubt", "now in_doubt"}, Step{7, "settled", "now settled"}));
    EXPECT_THAT(ledger.history(7), IsEmpty());
  };
  {
    auto ledger = open_or_fail(state.path());
    EXPECT_THAT(ledger.reports(), IsEmpty());
    EXPECT_THAT(ledger.runs(), IsEmpty());
    ASSERT_TRUE(ledger.write(first));
    ASSERT_TRUE(write(ledger, backpack(11)));
    ASSERT_TRUE(write(ledger, backpack(1), Flush::Soon));
    ASSERT_TRUE(ledger.write(steps, &second));
    first.id = "1.4";
    ASSERT_TRUE(ledger.write(first)) << "an earlier run may change";
    ASSERT_TRUE(ledger.write(std::span<const Report>()));
    check(ledger);
  }
  auto ledger = open_or_fail(state.path());
  check(ledger);
  ASSERT_TRUE(keep_up(ledger));
  EXPECT_EQ(ledger.known_facts().reports, 11);
}

/// The output that Reports needs.
struct ToLedger final : dispatch::Output {
  explicit ToLedger(Ledger& on) : ledger(on) {}
  bool write(std::span<const Report> steps, const dispatch::Run* run, Flush flush) override {
    return ledger.write(steps, run, flush).has_value();
  }
  void answer_client(dispatch::ClientId, const dispatch::ClientAnswer&, const Report&) override {}
  Ledger& ledger;
};

TEST(Ledger, RestoresACorrectedReport) {
  const State state;
  {
    auto ledger = open_or_fail(state.path());
    ToLedger output(ledger);
    dispatch::Reports reports({.review = dispatch::Review::All, .policy = {}}, output);
    reports.open({}, {}, {});
    reports.on_status({.score = 0, .run_clock = 1, .remaining_reports = 20, .current_team = "t"}, {}, {});
    reports.accept({.report = {.type = "Drill", .position = {1, 2, 3}}, .sender = "10.0.0.7"}, 1, true, {});
    ASSERT_TRUE(reports.correct(1, {.type = "Rope", .position = {4, 5, 6}}, {}));
  }
  auto ledger = open_or_fail(state.path());
  ASSERT_EQ(ledger.reports().size(), 2);
  EXPECT_EQ(ledger.reports()[0].report, (icd::ArtifactReport{.type = "Drill", .position = {1, 2, 3}}));
  EXPECT_EQ(ledger.reports()[1].report, (icd::ArtifactReport{.type = "Rope", .position = {4, 5, 6}}));
  EXPECT_TRUE(ledger.reports()[0].is_corrected());
  EXPECT_THAT(ledger.history(1),
              ElementsAre(Step{0, "queued", ""}, Step{0, "held", "every report is reviewed"},
                          Step{0, "withdrawn", "the operator corrected it: report 2, \"Rope\" at 4, 5, 6"}));
  EXPECT_THAT(ledger.history(2), ElementsAre(Step{0, "queued", "corrects report 1, \"Drill\" at 1, 2, 3"}));
  ToLedger output(ledger);
  dispatch::Reports reports({}, output);
  reports.open(ledger.reports(), ledger.runs(), {});
  EXPECT_EQ(reports.waiting_here(), std::vector<std::int64_t>{2});
}

TEST(Ledger, WritesAllStepsOrNone) {
  const State state;
  {
    auto ledger = open_or_fail(state.path());
    ASSERT_TRUE(write(ledger, backpack(1)));
    const std::vector<Report> steps{backpack(2), in_state(backpack(1), ReportState::Held), backpack(0)};
    EXPECT_THAT(ledger.write(steps).error().what, HasSubstr("report 0"));
    EXPECT_THAT(ledger.reports(), ElementsAre(backpack(1)));
    EXPECT_EQ(ledger.refusal(), "") << "the disk works";
    EXPECT_TRUE(write(ledger, backpack(2)));
  }
  EXPECT_EQ(open_or_fail(state.path()).history(1).size(), 1u);
}

/// The snapshot replaces the first file, and the records after it are read.
TEST(Ledger, KeepsAllThroughFullFilesAndSnapshots) {
  const State state;
  std::int64_t last = 0;
  {
    auto ledger = open_or_fail(state.path());
    for (int file = 0; file < 3; ++file) {
      last = fill_file(ledger, last + 1);
      ASSERT_TRUE(write(ledger, in_state(backpack(1), ReportState::Sending)));
      ASSERT_TRUE(keep_up(ledger));
      ASSERT_TRUE(keep_up(ledger));
    }
    EXPECT_EQ(ledger.known_facts().log, 4u);
  }
  const auto files = files_in(state.ledger());
  EXPECT_THAT(files, testing::Contains(testing::Key(testing::StartsWith("snapshot-00000004"))));
  EXPECT_THAT(files, testing::Contains(testing::Key(testing::StartsWith("spare-"))));
  EXPECT_THAT(files, testing::Not(testing::Contains(testing::Key(testing::StartsWith("log-00000002")))));
  const auto ledger = open_or_fail(state.path(), {.reports = last, .log = 4});
  EXPECT_EQ(ledger.damage(), "");
  EXPECT_EQ(ledger.reports().size(), static_cast<std::size_t>(last));
  EXPECT_EQ(ledger.history(1).size(), 4u);
}

TEST(Ledger, KeepsKindsOfALaterVersionInSnapshots) {
  const State state;
  (void)open_or_fail(state.path());
  append(state.ledger(), 9, "a later kind");
  {
    auto ledger = open_or_fail(state.path());
    (void)fill_file(ledger, 1);
    ASSERT_TRUE(keep_up(ledger));
  }
  const auto directory = store::Directory::open(state.ledger()).value();
  const auto contents = store::Contents::read(directory, Ledger::kKeeping).value();
  const auto& record = std::get<store::Record>(contents.items.front());
  EXPECT_EQ(record.sequence, 0u) << "the record is from a snapshot";
  EXPECT_EQ(record.kind, 9);
  EXPECT_EQ(record.body, "a later kind");
}

TEST(Ledger, DoesNotOpenWithAMandatoryUnknownRecord) {
  const State state;
  (void)open_or_fail(state.path());
  append(state.ledger(), store::kMustUnderstand | 1, "");
  const Files before = files_in(state.ledger());
  EXPECT_EQ(Ledger::open(state.path()).error().cause, Error::Cause::Newer);
  EXPECT_EQ(files_in(state.ledger()), before);
}

TEST(Ledger, IsPrivate) {
  const State state;
  const mode_t before = ::umask(0);
  auto ledger = open_or_fail(state.path());
  ASSERT_TRUE(keep_up(ledger));
  ::umask(before);
  const auto mode = [](const std::filesystem::path& path) {
    struct stat status{};
    EXPECT_EQ(::stat(path.c_str(), &status), 0);
    return status.st_mode & 0777;
  };
  EXPECT_EQ(mode(state.ledger()), 0700u);
  EXPECT_EQ(files_in(state.ledger()).size(), 2u);
  for (const auto& [name, bytes] : files_in(state.ledger()))
    EXPECT_EQ(mode(state.ledger() + '/' + name), 0600u);
}

TEST(Ledger, OpensOnceAtATime) {
  const State state;
  const auto ledger = open_or_fail(state.path());
  EXPECT_EQ(Ledger::open(state.path()).error().cause, Error::Cause::InUse);
  EXPECT_FALSE(Ledger::can_be_read(state.path()));
  EXPECT_EQ(Ledger::open(state.path() + "/absent").error().cause, Error::Cause::Other);
}

/// Its values only make damage of an older copy.
TEST(OpenLedger, GoesOnWithoutTheFileInMemory) {
  const State state;
  const std::string memory = state.path() + "/known";
  std::filesystem::create_directory(memory);
  auto ledger = Ledger::open(state.path(), {}, memory);
  ASSERT_TRUE(ledger) << ledger.error().what;
  EXPECT_EQ(ledger->warning(), memory + ": Is a directory");
  EXPECT_TRUE(write(*ledger, backpack(1)));
  std::filesystem::remove(memory);
  std::ofstream(memory) << "ADTL";
  ledger = Ledger::make_closed("", {});  // and gives up its lock
  ledger = Ledger::open(state.path(), {}, memory);
  ASSERT_TRUE(ledger) << ledger.error().what;
  EXPECT_EQ(ledger->warning(), memory + " is damaged");
  EXPECT_TRUE(write(*ledger, backpack(2)));
}

/// The stamp floor is written from it, so it must not forget the unreadable ledger.
TEST(ClosedLedger, RejectsReportsAndForgetsNothing) {
  auto ledger = Ledger::make_closed("x: Input/output error", {.reports = 20, .log = 3});
  EXPECT_TRUE(ledger.is_closed());
  EXPECT_EQ(ledger.refusal(), "x: Input/output error");
  EXPECT_THAT(ledger.reports(), IsEmpty());
  EXPECT_FALSE(write(ledger, backpack(1)));
  EXPECT_FALSE(ledger.make_ready());
  EXPECT_FALSE(ledger.take_over(Ledger::make_closed("", {}).copy().value_or(""), {}));
  EXPECT_TRUE(ledger.flush());
  EXPECT_FALSE(ledger.upkeep());
  EXPECT_THAT(ledger.copy().error().what, HasSubstr("cannot be read"))
      << "a spare would take it for the complete ledger";
  EXPECT_EQ(ledger.refusal(), "x: Input/output error");
  EXPECT_EQ(ledger.known_facts().reports, 20);
  EXPECT_EQ(ledger.known_facts().log, 3u);
}

/// A power cut may follow, which empties the memory. Then an older copy of the ledger would be believed.
TEST(ClosedLedger, KnowsWhatMemoryKnows) {
  const State state;
  const std::string memory = state.path() + "/known";
  LedgerFacts last;
  {
    auto ledger = open_or_fail(state.path(), {}, memory);
    ASSERT_TRUE(write(ledger, backpack(1)));
    last = ledger.known_facts();
  }
  EXPECT_EQ(Ledger::make_closed("", {}, memory).known_facts(), last);
  EXPECT_EQ(Ledger::make_closed("", {.reports = 20}, memory).known_facts().reports, 20);
}

TEST(ClosedLedger, IsReplacedByANewOneThatContinuesItsNumbers) {
  const State state;
  {
    auto ledger = open_or_fail(state.path());
    ASSERT_TRUE(write(ledger, backpack(1)));
  }
  const std::string file = state.ledger() + '/' + files_in(state.ledger()).begin()->first;
  std::filesystem::rename(file, state.path() + "/elsewhere");
  std::filesystem::create_directory(file);
  const auto unread = Ledger::open(state.path());
  ASSERT_FALSE(unread);
  EXPECT_THAT(unread.error().what, HasSubstr("not a regular file"));
  EXPECT_FALSE(Ledger::can_be_read(state.path()));
  EXPECT_TRUE(std::filesystem::is_directory(file)) << "the directory must not change";
  EXPECT_EQ(Ledger::set_aside(state.path()), "ledger.damaged-1");
  EXPECT_TRUE(Ledger::can_be_read(state.path()));
  const auto ledger = open_or_fail(state.path(), {.reports = 1, .log = 1});
  EXPECT_THAT(ledger.damage(), HasSubstr("report 1 is lost"));
  EXPECT_EQ(ledger.known_facts().reports, 1000);
  EXPECT_EQ(ledger.known_facts().log, 2u);
}

}  // namespace
}  // namespace adit::ledger
