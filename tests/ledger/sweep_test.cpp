// A ledger with each byte of its files flipped, or cut off there, in turn.
#include <gmock/gmock.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <set>

#include "ledger/folder.hpp"

namespace adit::ledger {
namespace {

using dispatch::ReportState;

/// What whoever runs it by hand says, or else `otherwise`.
std::size_t told(const char* variable, std::size_t otherwise) {
  const char* const value = std::getenv(variable);
  return value == nullptr ? otherwise : std::max<std::size_t>(1, std::strtoull(value, nullptr, 10));
}

int reports() {
  return static_cast<int>(told("ADIT_LEDGER_REPORTS", 40));
}

/// In memory where there is some: the disk is not what is tried here.
std::string below() {
  return ::access("/dev/shm", W_OK) == 0 ? "/dev/shm/" : testing::TempDir();
}

/// Reports on their way through a ledger, by a seed, and what the Command Post and the clients know of them.
class Life {
 public:
  explicit Life(Ledger& ledger) : ledger_(ledger) {
    run_.began = run_.heard = 5;
    run_.post = "10.100.1.200:8000";
    EXPECT_TRUE(ledger_.write(run_));
  }

  /// Each report is taken, most are sent, most of these are answered; of some the ledger hears more later.
  void live(int reports, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (int i = 0; i < reports; ++i) {
      dispatch::Report report = backpack(static_cast<std::int64_t>(all_.size()) + 1, 1.5 + i);
      report.run = 1;
      step(report);
      if (random() % 8 == 0) continue;  // it waits
      report.state = ReportState::Sending;
      report.sending = report.number;
      report.before = icd::RunStatus{3, 100.0 + i, 40 - i, "adit"};
      step(report);
      if (random() % 12 == 0) continue;  // nobody answers
      report.state = random() % 10 == 0 ? ReportState::Rejected : ReportState::Answered;
      report.status = report.state == ReportState::Answered ? 201 : 422;
      report.content_type = "application/json";
      report.answer = std::string(60 + random() % 200, 'a');
      step(report);
      if (random() % 3 != 0) continue;
      run_.heard += 10;
      run_.last = icd::RunStatus{3, run_.heard, 40 - i, "adit"};
      run_.status_clock = dispatch::Clock{run_.heard, true};
      EXPECT_TRUE(ledger_.write(run_));
    }
  }

  const std::map<std::int64_t, dispatch::Report>& all() const { return all_; }

 private:
  void step(dispatch::Report& report) {
    ++report.changed;
    ASSERT_TRUE(write(ledger_, report));
    all_[report.number] = report;
  }

  Ledger& ledger_;
  dispatch::Run run_{.number = 1};
  std::map<std::int64_t, dispatch::Report> all_;
};

/// How much of a log was ever written.
std::size_t used(const std::string& log) {
  const std::size_t last = log.find_last_not_of('\0');
  return last == std::string::npos ? 0 : std::min(log.size(), last + 1 + 4120);
}

/// The files of a ledger that was killed, or closed, and what was in it. `log` is what was written of it; up
/// to `log_size` there are zeros.
struct Files {
  std::string file, log;
  std::uintmax_t log_size;
  std::map<std::int64_t, dispatch::Report> all;
};

Files killed(int earlier = 0, int last = reports()) {
  const Folder folder(below());
  auto ledger = open_or_fail(folder);
  Life life(ledger);
  if (earlier > 0) {  // so many that the log is in its second round
    life.live(earlier, 3);
  }
  life.live(last, 7);
  const std::string log = bytes_of(folder.file() + "-wal");
  return {bytes_of(folder.file()), log.substr(0, used(log)), log.size(), life.all()};
}

Files closed() {
  const Folder folder(below());
  std::map<std::int64_t, dispatch::Report> all;
  {
    auto ledger = open_or_fail(folder);
    Life life(ledger);
    life.live(reports(), 7);
    all = life.all();
  }
  return {bytes_of(folder.file()), "", 0, all};
}

/// In that state it, or the same posted again, would be sent.
bool is_sent(const dispatch::Report& report) {
  return report.state == ReportState::Queued || report.state == ReportState::Rejected;
}

bool stays_what_it_was(const dispatch::Report& was, const dispatch::Report& is) {
  if (was.report != is.report || was.run != is.run) return false;
  if (is == was) return true;
  if (is.is_lost()) return false;
  return !is_sent(is) && (is.state != ReportState::Sending || !is.before);
}

struct Verdict {
  int whole = 0;    // all is as it was, without a word
  int said = 0;     // the opening said what is missing
  int refused = 0;  // it did not open, and said
  std::string why = "";
};

/// What became of a ledger whose files are these.
void judge(const Files& was, const std::string& file, const std::string& log, Verdict& verdict) {
  const Folder folder(below());
  save(folder.file(), file);
  if (!log.empty() || !was.log.empty()) save(folder.file() + "-wal", log);
  if (log.size() == was.log.size() && was.log_size > 0) {
    std::filesystem::resize_file(folder.file() + "-wal", was.log_size);
  }
  const auto ledger = Ledger::open(folder.text());
  if (!ledger) {
    EXPECT_FALSE(ledger.error().what.empty());
    ++verdict.refused;
    verdict.why = ledger.error().what;
    return;
  }
  const auto reports = ledger->reports();
  ASSERT_TRUE(reports) << reports.error().what;
  const auto runs = ledger->runs();
  ASSERT_TRUE(runs && !runs->empty());
  EXPECT_EQ(runs->back().number, 1) << "another run would send them again";
  std::map<std::int64_t, dispatch::Report> found;
  std::set<std::int64_t> lost;
  for (const dispatch::Report& report : *reports) {
    (report.is_lost() ? void(lost.insert(report.number)) : void(found.emplace(report.number, report)));
  }
  bool whole = true;
  for (const auto& [number, report] : was.all) {
    if (const auto is = found.find(number); is != found.end()) {
      EXPECT_TRUE(stays_what_it_was(report, is->second))
          << "report " << number << " was " << dispatch::name_of(report.state) << " and is "
          << dispatch::name_of(is->second.state) << ", " << ledger->damage();
      whole = whole && is->second == report;
    } else {
      EXPECT_NE(lost.lower_bound(number), lost.end()) << "report " << number << ": " << ledger->damage();
      whole = false;
    }
  }
  EXPECT_EQ(found.size() + static_cast<std::size_t>(!whole ? was.all.size() - found.size() : 0),
            was.all.size());
  EXPECT_TRUE(whole || !ledger->damage().empty()) << "something is missing without a word";
  ++(whole && ledger->damage().empty() ? verdict.whole : verdict.said);
}

/// Every `ADIT_LEDGER_SWEEP`-th byte; 1: all of them. As many as take seconds unless told otherwise.
std::size_t stride_of(std::size_t size, std::size_t samples) {
  return told("ADIT_LEDGER_SWEEP", std::max<std::size_t>(1, size / samples));
}

void sweep(const Files& was, std::size_t samples) {
  Verdict flipped, cut;
  std::mt19937_64 random(11);
  const auto change = [&](const std::string& bytes, std::size_t size,
                          const std::function<void(const std::string&, Verdict&)>& judged) {
    const std::size_t stride = stride_of(size, samples);
    for (std::size_t at = random() % stride; at < size; at += stride) {
      SCOPED_TRACE(at);
      std::string flip = bytes;
      flip[at] = static_cast<char>(flip[at] ^ (1 << random() % 8));
      judged(flip, flipped);
      EXPECT_EQ(flipped.refused, 0) << "one bit must not keep the service from starting: " << flipped.why;
      judged(bytes.substr(0, at), cut);
      if (testing::Test::HasFailure()) return;
    }
  };
  const testing::ScopedTrace of(__FILE__, __LINE__, "the file");
  change(was.file, was.file.size(),
         [&](const std::string& bytes, Verdict& verdict) { judge(was, bytes, was.log, verdict); });
  const testing::ScopedTrace of_log(__FILE__, __LINE__, "its log");
  change(was.log, was.log.size(),
         [&](const std::string& bytes, Verdict& verdict) { judge(was, was.file, bytes, verdict); });
  for (const auto& [what, verdict] : {std::pair{"flipped", flipped}, std::pair{"cut", cut}}) {
    std::printf("%s: %d whole, %d said, %d refused\n", what, verdict.whole, verdict.said, verdict.refused);
  }
}

TEST(SweptLedger, LosesNothingWithoutAWordAfterAKill) {
  sweep(killed(), 60);
}

TEST(SweptLedger, LosesNothingWithoutAWordAfterAKillInALaterRoundOfItsLog) {
  const Files files = killed(400);
  ASSERT_LT(files.log.size(), files.log_size);
  sweep(files, 20);
}

TEST(SweptLedger, LosesNothingWithoutAWordAfterAnOrderlyEnd) {
  sweep(closed(), 40);
}

/// A checksum tells less of a byte's highest bit than of the others, and of what comes last.
TEST(SweptLedger, SaysWhatAFirstReportsOnlyFrameHasLost) {
  const Folder folder(below());
  auto ledger = open_or_fail(folder);
  ASSERT_TRUE(ledger.write(dispatch::Run{.number = 1, .began = 5, .heard = 5, .post = "10.100.1.200:8000"}));
  dispatch::Report first = backpack(1);
  first.state = ReportState::Sending;
  first.run = 1;
  first.before = icd::RunStatus{3, 100, 40, "adit"};
  ASSERT_TRUE(write(ledger, first));
  const std::string log = bytes_of(folder.file() + "-wal");
  const Files was{bytes_of(folder.file()), log.substr(0, used(log)), log.size(), {{1, first}}};
  const std::size_t end = used(was.log) - 4120;
  ASSERT_GT(end, 4120u);
  Verdict verdict;
  const auto flip = [&](std::size_t at, int bit) {
    SCOPED_TRACE(testing::Message() << "byte " << at << ", bit " << bit);
    std::string flipped = was.log;
    flipped[at] = static_cast<char>(flipped[at] ^ (1 << bit));
    judge(was, was.file, flipped, verdict);
  };
  const std::size_t stride = told("ADIT_LEDGER_SWEEP", 4);
  for (std::size_t at = end - 300; at < end && !testing::Test::HasFailure(); at += stride) flip(at, 7);
  for (std::size_t at = end - 8; at < end; ++at) {
    for (int bit = 0; bit < 8 && !testing::Test::HasFailure(); ++bit) flip(at, bit);
  }
  EXPECT_EQ(verdict.refused, 0);
}

/// What is cut off of a page reads as zeros, a proof too.
TEST(SweptLedger, TakesNoZerosForARowWithoutAProof) {
  const Files was = closed();
  const std::size_t last = was.file.rfind("10.0.0.7");
  ASSERT_NE(last, std::string::npos);
  const std::size_t stride = told("ADIT_LEDGER_SWEEP", 4);
  for (std::size_t at = last; at < std::min(last + 400, was.file.size()); at += stride) {
    SCOPED_TRACE(at);
    Verdict verdict;
    judge(was, was.file.substr(0, at), "", verdict);
    EXPECT_EQ(verdict.said, 1);
  }
}

/// Where a word's highest bit is wrong, many words explain it: a page number was not put right, and what the
/// page said was gone.
TEST(SweptLedger, SaysThatAPageNumberIsWrong) {
  const Files was = killed(0, 4);
  for (std::size_t frame = 32; frame + 2 * 4120 <= was.log.size(); frame += 4120) {
    for (int bit = 0; bit < 8; ++bit) {
      SCOPED_TRACE(testing::Message() << "frame " << frame << ", bit " << bit);
      std::string log = was.log;
      log[frame + 3] = static_cast<char>(log[frame + 3] ^ (1 << bit));
      Verdict verdict;
      judge(was, was.file, log, verdict);
      EXPECT_EQ(verdict.said, 1);
    }
  }
}

/// A byte of its checksum may look like one of its salt.
TEST(SweptLedger, PutsEachByteOfItsLogsHeaderRight) {
  const Files was = killed();
  for (std::size_t at = 0; at < 32; ++at) {
    for (const int bit : {0, 4, 7}) {
      SCOPED_TRACE(at);
      std::string log = was.log;
      log[at] = static_cast<char>(log[at] ^ (1 << bit));
      Verdict verdict;
      judge(was, was.file, log, verdict);
      EXPECT_EQ(verdict.said, 1);
    }
  }
}

/// What SQLite's own header says of the format forbids writing, or reading, with one bit.
TEST(SweptLedger, IsOpenedWhateverItsHeaderForbids) {
  const std::size_t stride = told("ADIT_LEDGER_SWEEP", 4);
  for (const Files& was : {killed(), closed()}) {
    for (std::size_t at = 0; at < 100; ++at) {
      for (std::size_t bit = at % stride; bit < 8 && !testing::Test::HasFailure(); bit += stride) {
        SCOPED_TRACE(testing::Message() << "byte " << at << ", bit " << bit);
        std::string file = was.file;
        file[at] = static_cast<char>(file[at] ^ (1 << bit));
        Verdict verdict;
        judge(was, file, was.log, verdict);
        EXPECT_EQ(verdict.refused, 0) << verdict.why;
      }
    }
  }
}

TEST(SweptLedger, SaysThatItsLogIsGone) {
  const Files was = killed();
  const Folder folder(below());
  save(folder.file(), was.file);
  const auto ledger = open_or_fail(folder);
  EXPECT_THAT(ledger.damage(), testing::HasSubstr("its log: the file is missing"));
}

/// SQLite has all pages from what is left of the log, and misses none.
TEST(SweptLedger, SaysThatItsLogIsCutWhereTheFileIsToo) {
  const Files was = killed();
  for (std::size_t pages = 0; 4096 * pages < was.file.size(); ++pages) {
    SCOPED_TRACE(pages);
    Verdict verdict;
    judge(was, was.file.substr(0, 4096 * pages + 2000), was.log.substr(0, was.log.size() / 2), verdict);
    EXPECT_EQ(verdict.said, 1);
  }
}

TEST(SweptLedger, SaysNothingWhereNothingIsDamaged) {
  for (const Files& was : {killed(), killed(400), closed()}) {
    Verdict verdict;
    judge(was, was.file, was.log, verdict);
    EXPECT_EQ(verdict.whole, 1);
  }
}

}  // namespace
}  // namespace adit::ledger
