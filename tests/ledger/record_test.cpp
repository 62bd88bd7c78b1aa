// Records and the book that they add up to.

#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <regex>

#include "ledger/book.hpp"
#include "ledger/state.hpp"
#include "project_files.hpp"
#include "store/frame.hpp"

namespace adit::ledger {
namespace {

using dispatch::Report;
using dispatch::ReportState;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::uint8_t kSteps = 1;

/// A report with a value in every member.
Report full_report() {
  return {.number = 2,
          .report = {"Drill", {1.5, -0.0, 1e308}, icd::RobotName::parse("spot1")},
          .sender = "10.0.0.7",
          .received = 10,
          .changed = 12.5,
          .state = ReportState::Answered,
          .note = "scored",
          .run = 3,
          .asked = true,
          .same_as = 1,
          .tries = 4,
          .sending = 17,
          .sent = 12.25,
          .before = icd::RunStatus{-5, 831.5, 19, "adit"},
          .beside = 2,
          .counted = true,
          .uncertain = "a report was granted",
          .status = 201,
          .content_type = "application/json",
          .answer = R"({"score_change":1})",
          .reconciled = true};
}
dispatch::Run full_run() {
  return {.number = 2,
          .id = "1.5.2",
          .began = 900,
          .why = "its clock ran backward",
          .last = icd::RunStatus{7, 0.5, 25, "adit"},
          .heard = 901,
          .post = "10.100.1.200:8000",
          .unreliable = "another sender",
          .turn = 3,
          .may_be = 1,
          .status_clock = dispatch::Clock{0.5, true},
          .answer_clock = dispatch::Clock{3.25, false},
          .signs = {.count = true, .score = true},
          .name_trouble = "each answer another name"};
}

std::string in_hex(std::string_view bytes) {
  std::string hex;
  for (const char byte : bytes) {
    for (const int digit : {static_cast<std::uint8_t>(byte) / 16, static_cast<std::uint8_t>(byte) % 16})
      hex += "0123456789abcdef"[digit];
  }
  return hex;
}

/// The format of 0.1.0 (firmware/doors/ledger/README.md). It never changes. Later members come after these.
TEST(LedgerRecord, HasTheseBytes) {
  const std::string report = to_bytes(full_report()), run = to_bytes(full_run());
  const std::string history = to_bytes(Step{10, "queued", "why"});
  EXPECT_EQ(in_hex(to_bytes(Steps{.highest = 7, .reports = {{report, history}}, .runs = {run}})),
            "070000000000000001000000000000004201000000000000020000000000000005000000000000004472696c6c000000"
            "000000f83f0000000000000080a0c8eb85f3cce17f050000000000000073706f7431080000000000000031302e302e30"
            "2e37000000000000244000000000000029400800000000000000616e737765726564060000000000000073636f726564"
            "030000000000000001000000000000000100000000000000040000000000000011000000000000000000000000802840"
            "0100000000000000fbffffffffffffff0000000000fc89401300000000000000040000000000000061646974c9000000"
            "0000000010000000000000006170706c69636174696f6e2f6a736f6e12000000000000007b2273636f72655f6368616e"
            "6765223a317d010000000000000002000000000000000100000000000000140000000000000061207265706f72742077"
            "6173206772616e7465642100000000000000000000000000244006000000000000007175657565640300000000000000"
            "77687901000000000000001e0100000000000002000000000000000500000000000000312e352e320000000000208c40"
            "160000000000000069747320636c6f636b2072616e206261636b77617264010000000000000007000000000000000000"
            "00000000e03f19000000000000000400000000000000616469740000000000288c40110000000000000031302e313030"
            "2e312e3230303a383030300e00000000000000616e6f746865722073656e646572030000000000000001000000000000"
            "000100000000000000000000000000e03f010000000000000001000000000000000000000000000a4000000000000000"
            "00010000000000000000000000000000000100000000000000000000000000000018000000000000006561636820616e"
            "7377657220616e6f74686572206e616d65");
}

/// Commit 937b95d6 wrote these files: a snapshot, and a log without the zeros behind its last record.
TEST(LedgerRecord, IsReadFromFilesOfAnEarlierVersion) {
  const State state;
  std::filesystem::copy(project_file("tests/ledger/earlier"), state.ledger());
  for (const auto& [name, bytes] : files_in(state.ledger())) {
    if (name.starts_with("log-"))
      std::filesystem::resize_file(state.ledger() + '/' + name, Ledger::kKeeping.file_bytes);
  }
  const Ledger ledger = open_or_fail(state.path());
  EXPECT_EQ(ledger.damage(), "");
  Report answered = full_report(), doubt = in_state(backpack(3), ReportState::InDoubt);
  answered.run = doubt.run = 2;
  doubt.note = "no answer";
  EXPECT_THAT(ledger.reports(), ElementsAre(backpack(1), answered, doubt));
  EXPECT_THAT(ledger.history(2),
              ElementsAre(Step{10, "queued", ""}, Step{11, "sending", ""}, Step{12.5, "answered", "scored"}));
  EXPECT_THAT(ledger.runs(),
              ElementsAre(dispatch::Run{.number = 1, .began = 5, .post = "10.100.1.200:8000"}, full_run()));
}

TEST(LedgerRecord, ReadsBackEachMember) {
  EXPECT_EQ(report_in(to_bytes(full_report())), full_report());
  EXPECT_EQ(run_in(to_bytes(full_run())), full_run());
  EXPECT_EQ(report_in(to_bytes(backpack(1))), backpack(1));
  EXPECT_EQ(run_in(to_bytes(dispatch::Run())), dispatch::Run());
  for (std::size_t state = 0; state < std::size(dispatch::kStateWords); ++state) {
    const Report report = in_state(full_report(), static_cast<ReportState>(state));
    EXPECT_EQ(report_in(to_bytes(report)), report);
  }
}

TEST(LedgerRecord, IsDescribedForOtherReaders) {
  const std::string readme = project_text("firmware/doors/ledger/README.md"),
                    reader = project_text("tests/wire/ledger_files.py");
  for (const codec::Value& record : {to_value(full_report()), to_value(full_run())}) {
    for (const auto& [name, value] : std::get<codec::Value::Object>(record.is)) {
      EXPECT_THAT(readme, HasSubstr('`' + name + '`'));
      EXPECT_TRUE(std::regex_search(reader, std::regex(R"([" ])" + name + ":")))
          << "ledger_files.py: " << name;
    }
  }
}

TEST(LedgerRecord, ReadsBackHostileTextUnchanged) {
  for (const std::string& text : {std::string("nul\0inside", 10), std::string("\xff\xfe not UTF-8"),
                                  std::string("ADTL"), std::string(70000, 'x')}) {
    Report report = full_report();
    report.report.type = report.sender = report.note = report.content_type = report.answer = text;
    report.before = icd::RunStatus{std::numeric_limits<std::int64_t>::min(), -1e308,
                                   std::numeric_limits<std::int64_t>::max(), text};
    EXPECT_EQ(report_in(to_bytes(report)), report);
    dispatch::Run run = full_run();
    run.id = run.why = run.post = run.unreliable = text;
    EXPECT_EQ(run_in(to_bytes(run)), run);
    EXPECT_THAT(steps_in(to_bytes(Step{1, "queued", text})),
                testing::Optional(ElementsAre(Step{1, "queued", text})));
  }
}

TEST(LedgerRecord, IsRejectedWithAWrongLengthOrNumber) {
  const std::string report = to_bytes(full_report()), run = to_bytes(full_run()),
                    step = to_bytes(Step{10, "queued", ""});
  const std::string whole = to_bytes(Steps{.highest = 7, .reports = {{report, step}}, .runs = {run}});
  ASSERT_TRUE(steps_record_in(whole));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_FALSE(steps_record_in(whole.substr(0, size)));
  EXPECT_FALSE(steps_record_in(whole + 'x'));
  EXPECT_FALSE(report_in(to_bytes(Report())));
  EXPECT_FALSE(run_in(to_bytes(dispatch::Run{.number = 0})));
  EXPECT_FALSE(steps_in(step.substr(1)));
  EXPECT_FALSE(Ledger::is_copy("ledger.sqlite"));
}

TEST(LedgerRecord, UnknownStateIsInDoubtAndKeepsItsWord) {
  std::string later = to_bytes(full_report());
  later.replace(later.find("answered"), 8, "promised");
  const auto report = report_in(later);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->state, ReportState::InDoubt);
  EXPECT_EQ(report->note, "its state 'promised' is unknown to this version; scored");
  EXPECT_EQ(report->before, std::nullopt);
  EXPECT_THAT(steps_in(to_bytes(Step{1, "promised", ""})),
              testing::Optional(ElementsAre(Step{1, "promised", ""})));
}

/// This version reads and writes between two starts of a later version.
TEST(LedgerRecord, KeepsMembersAndKindsOfALaterVersion) {
  Book book;
  const std::string report = to_bytes(full_report(), "its more"), run = to_bytes(full_run(), "run's more");
  ASSERT_TRUE(book.apply(kSteps, to_bytes(Steps{.highest = 2, .reports = {{report, ""}}, .runs = {run}})));
  ASSERT_TRUE(book.apply(9, "a later kind"));
  const auto write_again = [](const Book& from) {
    Book next;
    for (const auto& [kind, body] : from.records()) EXPECT_TRUE(next.apply(kind, body));
    return next;
  };
  Book next = write_again(book);
  const Report step = in_state(full_report(), ReportState::Settled);
  dispatch::Run heard = full_run();
  heard.heard = 950;
  ASSERT_TRUE(next.apply(kSteps, next.record(std::span(&step, 1), &heard).value()));
  const dispatch::TakeoverChanges taken{.reports = {{.report = in_state(step, ReportState::InDoubt)}},
                                        .runs = {heard}};
  ASSERT_TRUE(next.apply(kSteps, next.record(taken, Book()).value()));
  next.salvage(20, 2, false);
  next = write_again(next);
  const std::string copy = next.copy();
  const auto last = steps_record_in(copy);
  ASSERT_TRUE(last);
  EXPECT_EQ(more_of_report(last->reports.back().report), "its more");
  EXPECT_EQ(more_of_run(last->runs.front()), "run's more");
  EXPECT_THAT(next.records(), testing::Contains(std::pair<std::uint8_t, std::string>(9, "a later kind")));
}

TEST(LedgerBook, ReplacesNoReportByAnother) {
  Book book;
  const std::vector<Report> first{backpack(1)};
  ASSERT_TRUE(book.apply(kSteps, book.record(first, nullptr).value()));
  std::vector<Report> others(4, backpack(1));
  others[0].report.type = "Drill";
  others[1].report.position.x = 7;
  others[2].report.position.z = 7;
  others[3].received = 11;
  for (const Report& other : others) {
    EXPECT_THAT(book.record(std::span(&other, 1), nullptr).error().what,
                HasSubstr("another report has this number"));
    const std::vector<Report> both{in_state(backpack(2), ReportState::Held),
                                   in_state(other, ReportState::Held)};
    std::vector<Report> twice{backpack(3), other};
    twice[1].number = 3;
    EXPECT_FALSE(book.record(both, nullptr));
    EXPECT_FALSE(book.record(twice, nullptr)) << "two reports of one write have one number";
  }
}

TEST(LedgerBook, RejectsANonFiniteNumber) {
  const auto is_refused = [](const Report& report) { return !Book().record(std::span(&report, 1), nullptr); };
  Report report = backpack(1);
  report.before = icd::RunStatus{0, std::nan(""), 0, ""};
  EXPECT_TRUE(is_refused(report));
  EXPECT_TRUE(is_refused(backpack(1, std::nan(""))));
  EXPECT_TRUE(is_refused(backpack(0)));
  const dispatch::Run no_clock{.number = 1, .last = icd::RunStatus{0, std::nan(""), 0, ""}},
      no_number{.number = 0};
  EXPECT_FALSE(Book().record({}, &no_clock));
  EXPECT_FALSE(Book().record({}, &no_number));
}

/// A lost report's number is reported, and no number is used twice.
TEST(LedgerBook, NamesLostReports) {
  Book book;
  for (const std::int64_t number : {2, 3, 6}) {
    const Report report =
        in_state(backpack(number), number == 3 ? ReportState::Answered : ReportState::Rejected);
    ASSERT_TRUE(book.apply(kSteps, book.record(std::span(&report, 1), nullptr).value()));
  }
  EXPECT_EQ(book.salvage(20, 7, true),
            "3 reports were read; report 1 is lost from the ledger; reports 4 to 5 are lost from the ledger; "
            "report 7 is lost from the ledger; reports may be missing from number 8 on");
  std::vector<std::int64_t> lost;
  for (const Report& report : book.reports()) {
    if (report.is_lost()) lost.push_back(report.number);
    EXPECT_EQ(report.state, report.number == 3 ? ReportState::Answered : ReportState::InDoubt);
    EXPECT_EQ(report.run, 1);
  }
  EXPECT_THAT(lost, ElementsAre(1, 5, 7, 1000));
  EXPECT_EQ(book.highest(), 1000);
  EXPECT_THAT(book.runs().at(0).unreliable, HasSubstr("damaged"));
}

}  // namespace
}  // namespace adit::ledger
