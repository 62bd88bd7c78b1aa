#include "ledger/ledger.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "ledger/database.hpp"
#include "ledger/files.hpp"
#include "ledger/mark.hpp"
#include "ledger/opening.hpp"
#include "ledger/rows.hpp"
#include "ledger/scratch.hpp"

namespace adit::ledger {
namespace {

/// A ledger is some kilobytes, and begins with a few.
constexpr const char* kFile = "/ledger.sqlite";
constexpr std::int64_t kRoomToBegin = 1 << 20;

/// All that a statement without parameters reads.
template <class Row>
Result<std::vector<Row>> rows_of(const Database& database, const Statement& statement,
                                 Row (*row_of)(const Query&), const char* doing, std::size_t about) {
  Query query(statement);
  std::vector<Row> all;
  all.reserve(about);
  int result = SQLITE_OK;
  while ((result = query.step()) == SQLITE_ROW) all.push_back(row_of(query));
  if (result != SQLITE_DONE) return std::unexpected(database.error(doing));
  return all;
}

}  // namespace

class Ledger::Impl {
 public:
  static Result<std::unique_ptr<Impl>> make(Opened opened) {
    auto impl = std::make_unique<Impl>(std::move(opened));
    const std::pair<Statement*, const std::string&> statements[] = {{&impl->write_report_, kWriteReport},
                                                                    {&impl->write_run_, kWriteRun},
                                                                    {&impl->write_sighting_, kWriteSighting},
                                                                    {&impl->write_robot_, kWriteRobot},
                                                                    {&impl->read_reports_, kReadReports},
                                                                    {&impl->read_history_, kReadHistory},
                                                                    {&impl->read_runs_, kReadRuns}};
    for (const auto& [statement, sql] : statements) {
      auto prepared = Statement::prepare(impl->database_, sql);
      if (!prepared) return std::unexpected(prepared.error());
      *statement = std::move(*prepared);
    }
    sqlite3_wal_hook(impl->database_.get(), &Impl::note_pages, impl.get());
    return impl;
  }

  /// What the file says of itself alone is then so.
  ~Impl() {
    (void)flush_each(false);  // closing flushes
    (void)write_mark(database_, false, 0);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  explicit Impl(Opened opened) : database_(std::move(opened.database)), damage_(std::move(opened.damage)) {}

  Result<void> write(std::span<const dispatch::Report> steps, const dispatch::Run* run,
                     dispatch::Flush flush) {
    if (steps.empty() && run == nullptr) return {};
    if (!refusal_.empty()) return std::unexpected(Error{Error::Kind::ReadOnly, refusal_});
    const bool soon = flush == dispatch::Flush::Soon;
    if (auto mended = mend_log(); !mended) return mended;
    if (auto set = flush_each(!soon); !set) return set;
    unflushed_ = unflushed_ || soon;
    auto written = write(steps, run);
    has_hole_ = has_hole_ || (!written && unflushed_);
    if (pages_ >= kPagesOfLog) restart_log();
    return written;
  }

  Result<void> flush() {
    if (auto mended = mend_log(); !mended) return mended;
    if (!unflushed_) return {};
    sqlite3_file* const log = database_.log();
    if (log != nullptr && log->pMethods->xSync(log, SQLITE_SYNC_NORMAL) != SQLITE_OK) {
      has_hole_ = true;
      return std::unexpected(Error{.what = "the ledger's log could not be flushed"});
    }
    unflushed_ = false;
    return flush_each(true);  // here, where nobody waits for it
  }

  static int note_pages(void* self, sqlite3*, const char*, int pages) {
    static_cast<Impl*>(self)->pages_ = pages;
    return SQLITE_OK;
  }

  bool restart_log() {
    (void)flush_each(false);  // taking it over flushes all that is in it
    return take_over_log(database_);
  }

  /// What was not flushed when a flush failed never will be, though it reads well: a power cut would take all
  /// that is in the log behind it.
  Result<void> mend_log() {
    if (!has_hole_) return {};
    if (!restart_log()) return std::unexpected(Error{.what = "the ledger's log could not be restarted"});
    has_hole_ = unflushed_ = false;
    return flush_each(true);
  }

  /// NORMAL differs from FULL in this alone: the log is not flushed at the end of a transaction.
  Result<void> flush_each(bool each) {
    if (each == flushes_each_) return {};
    const char* const set = each ? "PRAGMA synchronous = FULL" : "PRAGMA synchronous = NORMAL";
    if (auto done = database_.execute(set); !done) return std::unexpected(done.error());
    flushes_each_ = each;
    return {};
  }

  /// A statement alone is a transaction of its own.
  Result<void> write(std::span<const dispatch::Report> steps, const dispatch::Run* run) {
    if (run == nullptr && of_the_first(steps) == steps.size() && !steps.back().report.robot)
      return write_one(steps);
    Transaction transaction(database_);
    if (auto begun = transaction.begin(); !begun) return std::unexpected(begun.error());
    while (!steps.empty()) {
      const std::size_t count = of_the_first(steps);
      if (auto written = write_one(steps.first(count)); !written) return written;
      steps = steps.subspan(count);
    }
    if (run != nullptr) {
      if (auto written = write_one(*run); !written) return written;
    }
    if (auto committed = transaction.commit(); !committed) return std::unexpected(committed.error());
    return {};
  }

  /// How many of the steps, from the first on, are of the same report.
  static std::size_t of_the_first(std::span<const dispatch::Report> steps) {
    std::size_t count = 0;
    while (count < steps.size() && steps[count].number == steps[0].number) ++count;
    return count;
  }

  Result<void> write_one(const dispatch::Run& run) {
    Query query(write_run_);
    bind_run(query, run);
    Query sighting(write_sighting_);
    bind_sighting(sighting, run);
    if (query.step() == SQLITE_DONE && sighting.step() == SQLITE_DONE) return {};
    return std::unexpected(database_.error("recording run " + std::to_string(run.number)));
  }

  /// Steps of one report: one row.
  Result<void> write_one(std::span<const dispatch::Report> steps) {
    return write_one(steps.back(), history_of(steps));
  }

  /// `history`: what is added to that of the report.
  Result<void> write_one(const dispatch::Report& report, const std::string& history) {
    const auto doing = [&] { return "recording a step of report " + std::to_string(report.number); };
    Query row(write_report_);
    bind_report(row, report, history);
    if (row.step() != SQLITE_DONE) return std::unexpected(database_.error(doing()));
    if (sqlite3_changes(database_.get()) != 1)
      return std::unexpected(Error{.what = doing() + ": another report has this number"});
    if (!report.report.robot) return {};
    Query robot(write_robot_);
    bind_robot(robot, report.number, *report.report.robot);
    if (robot.step() != SQLITE_DONE) return std::unexpected(database_.error(doing()));
    return {};
  }

  /// The history of a report as it is kept.
  Result<std::string> history_text(std::int64_t number) const {
    Query query(read_history_);
    query.bind(number);
    const int result = query.step();
    if (result == SQLITE_ROW) return query.bytes(0);
    if (result == SQLITE_DONE) return std::string();
    return std::unexpected(database_.error("reading the history of report " + std::to_string(number)));
  }

  /// `there`: where what is new here comes from.
  Result<void> write(const dispatch::TakeOver& taken, const Impl& there) {
    Transaction transaction(database_);
    if (auto begun = transaction.begin(); !begun) return std::unexpected(begun.error());
    for (const dispatch::Run& run : taken.runs) {
      if (auto written = write_one(run); !written) return written;
    }
    for (const dispatch::TakenOver& each : taken.reports) {
      std::string history;
      if (each.there != 0) {
        auto before = there.history_text(each.there);
        if (!before) return std::unexpected(std::move(before.error()));
        history = *std::move(before);
      }
      if (each.has_stepped) history += history_of({&each.report, 1});
      if (auto written = write_one(each.report, history); !written) return written;
    }
    if (auto committed = transaction.commit(); !committed) return std::unexpected(committed.error());
    return {};
  }

  Scratch scratch_;            // before the database, which is in it
  loop::FileDescriptor lock_;  // of the folder, for as long as the database is open
  Database database_;          // before the statements, which it outlives
  std::string damage_, refusal_;
  std::string unread_;        // why what this stands in for cannot be read
  bool flushes_each_ = true;  // as it was opened
  int pages_ = 0;             // in the log
  bool unflushed_ = false;    // something was written whose flush was left for later
  bool has_hole_ = false;     // and that failed
  Statement write_report_, write_run_, write_sighting_, write_robot_, read_reports_, read_history_,
      read_runs_;
};

Ledger::Ledger(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Ledger::Ledger(Ledger&&) noexcept = default;
Ledger& Ledger::operator=(Ledger&&) noexcept = default;
Ledger::~Ledger() = default;

Result<Ledger> Ledger::open_unlocked(const std::string& folder) {
  auto opened = open_database(folder);
  if (!opened) return std::unexpected(std::move(opened.error()));
  auto impl = Impl::make(std::move(*opened));
  if (!impl) return std::unexpected(std::move(impl.error()));
  return Ledger(std::move(*impl));
}

Result<Ledger> Ledger::open(const std::string& folder) {
  auto lock = lock_folder(folder);
  if (!lock) return std::unexpected(std::move(lock.error()));
  auto ledger = open_unlocked(folder);
  if (ledger) ledger->impl_->lock_ = std::move(*lock);
  return ledger;
}

Result<Ledger> Ledger::stand_in(const std::string& folder, const std::string& scratch,
                                const std::string& why) {
  Scratch made(scratch);
  if (made.path().empty()) return std::unexpected(system_error("creating a directory in " + scratch));
  std::string unread;
  if (auto copied = copy_database(folder + kFile, made.path() + kFile); !copied) {
    unread = "its content cannot be read: " + copied.error().what;
    remove_database(made.path() + kFile);
  }
  auto opened = open_unlocked(made.path());  // `made` has the lock
  if (!opened) return opened;
  opened->impl_->refusal_ = unread.empty() ? why : why + "; " + unread;
  opened->impl_->unread_ = unread;
  opened->impl_->scratch_ = std::move(made);
  return opened;
}

void Ledger::sweep(const std::string& folder, const std::string& scratch) {
  remove_trials(folder);
  sweep_scratch(scratch);
}

bool Ledger::can_be_opened(const std::string& folder) {
  // Tables of an earlier version are written again, and so is a ledger that is salvaged.
  return try_opening(folder + kFile) && try_room(folder, kRoomToBegin + 2 * size_of(folder + kFile)) &&
         sync_folder(folder);
}

Result<void> Ledger::write(std::span<const dispatch::Report> steps, const dispatch::Run* run,
                           dispatch::Flush flush) {
  return impl_->write(steps, run, flush);
}
void Ledger::expect(dispatch::Flush flush) {
  (void)impl_->flush_each(flush == dispatch::Flush::Now);  // where that fails, so will write(), and say so
}

Result<void> Ledger::flush() {
  return impl_->flush();
}
Result<std::vector<dispatch::Report>> Ledger::reports() const {
  constexpr std::int64_t kNoMore = 100'000;  // whatever a damaged number says
  const auto highest = impl_->database_.number("SELECT coalesce(max(number), 0) FROM report");
  if (!highest) return std::unexpected(impl_->database_.error("reading the reports"));
  const auto about = static_cast<std::size_t>(std::clamp<std::int64_t>(*highest, 0, kNoMore));
  return rows_of(impl_->database_, impl_->read_reports_, report_of, "reading the reports", about);
}
Result<std::vector<dispatch::Run>> Ledger::runs() const {
  return rows_of(impl_->database_, impl_->read_runs_, run_of, "reading the runs", 0);
}

Result<std::vector<Ledger::Step>> Ledger::history(std::int64_t number) const {
  const auto doing = [number] { return "reading the history of report " + std::to_string(number); };
  Query query(impl_->read_history_);
  query.bind(number);
  const int result = query.step();
  if (result == SQLITE_DONE) return std::vector<Step>();
  if (result != SQLITE_ROW) return std::unexpected(impl_->database_.error(doing()));
  auto steps = steps_of(number, query.bytes(0));
  if (!steps) return std::unexpected(Error{.what = doing() + ": it is damaged"});
  return *std::move(steps);
}

Result<std::string> Ledger::copy() const {
  if (!impl_->unread_.empty())
    return std::unexpected(Error{Error::Kind::Failing, "the ledger: " + impl_->unread_});
  sqlite3_int64 size = 0;
  const std::unique_ptr<unsigned char, decltype(&sqlite3_free)> bytes(
      sqlite3_serialize(impl_->database_.get(), "main", &size, 0), &sqlite3_free);
  if (!bytes) return std::unexpected(impl_->database_.error("copying the ledger"));
  return std::string(reinterpret_cast<const char*>(bytes.get()), static_cast<std::size_t>(size));
}

Result<void> Ledger::take_over(const Ledger& there, const dispatch::Handover& handover) {
  dispatch::Books books[2];
  const Ledger* const ledgers[] = {this, &there};
  for (std::size_t i = 0; i < std::size(ledgers); ++i) {
    auto reports = ledgers[i]->reports();
    if (!reports) return std::unexpected(std::move(reports.error()));
    auto runs = ledgers[i]->runs();
    if (!runs) return std::unexpected(std::move(runs.error()));
    books[i] = {*std::move(reports), *std::move(runs)};
  }
  if (!impl_->refusal_.empty()) return std::unexpected(Error{Error::Kind::ReadOnly, impl_->refusal_});
  return impl_->write(dispatch::take_over(books[0], books[1], handover), *there.impl_);
}

const std::string& Ledger::damage() const {
  return impl_->damage_;
}
const std::string& Ledger::refusal() const {
  return impl_->refusal_;
}

}  // namespace adit::ledger
