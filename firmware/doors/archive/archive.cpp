#include "archive/archive.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "archive/run_records.hpp"
#include "archive/run_report.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::archive {

StoredRuns::StoredRuns(loop::Writer& writer, RunsFolder folder)
    : writer_(writer), folder_(std::move(folder)) {
  refresh();
}

StoredRuns::~StoredRuns() {
  *ending_ = true;
}

void StoredRuns::refresh() {
  const auto listed = std::make_shared<std::expected<RunsFolder::List, std::string>>();
  writer_.submit([listed, folder = folder_] { *listed = folder.list(); },
                 [this, listed] {
                   if (*listed) {
                     list_ = std::move(**listed);
                   } else {
                     host::log(host::Level::Warning, "cannot list stored runs", {{"why", listed->error()}});
                     list_.unreadable = "cannot list stored runs: " + listed->error();
                   }
                 },
                 [] {});
}

bool StoredRuns::resize(const std::string& key, std::uint64_t bytes) {
  const auto row = std::ranges::find(list_.runs, key, &api::RunRow::key);
  if (row == list_.runs.end()) return false;
  row->bytes = bytes;
  return true;
}

namespace {

using ReadRun = icd::Checked<std::shared_ptr<api::KeptRun>>;

/// Reads a run. Skips unreadable files and damaged records, and reports them in the log and in the run's own
/// list of attention. Blocks on the disk until all is read or `enough` returns true.
void read_all(const RunsFolder& runs, const std::string& key, RunRecords& told,
              const std::function<bool()>& enough) {
  const auto all_read = read_run(runs.folder_of(key), told, enough);
  if (all_read && told.damaged_records() == 0) return;
  const std::string why =
      all_read ? icd::sentence("damaged records: ", told.damaged_records()) : all_read.error();
  host::log(host::Level::Error, "a part of a stored run is lost; the rest is used",
            {{"run", key}, {"why", why}});
  told.samples().add(api::AttentionStep{told.last(), true,
                                        "a part of the run's stored map, tracks and plots is lost: " + why});
}

/// The present run's row as it is now, others as on disk. Converts the start from the stamp clock, which the
/// ledger uses, to the time of day, like the end.
api::RunRow with_times(const api::RunRow& row, const api::RunRow& present) {
  api::RunRow told = row.key == present.key ? present : row;
  told.bytes = row.bytes;
  if (told.began > 0 && told.stamp) told.began += told.last - *told.stamp;
  return told;
}

std::unexpected<icd::Refusal> unread(const std::string& why) {
  return icd::refuse(icd::Status::ServiceUnavailable, "cannot read the stored run: ", why);
}

/// Blocks on the disk.
ReadRun kept_run(const RunsFolder& runs, const std::string& key, const api::RunRow& present,
                 const std::function<bool()>& enough) {
  const auto known = runs.facts_of(key);
  if (!known) {
    host::log(host::Level::Warning, "cannot read a stored run", {{"why", known.error()}});
    return unread(known.error());
  }
  if (!*known) return std::unexpected(api::no_such_run());
  const api::RunRow& facts = **known;
  RunRecords told(StoredRuns::kLookedAt);
  read_all(runs, key, told, enough);
  return std::make_shared<api::KeptRun>(api::KeptRun{with_times(facts, present), std::move(told.picture()),
                                                     told.tracks(), told.samples().history_after(0)});
}

}  // namespace

void StoredRuns::read(const std::string& key, const api::RunRow& present, api::KeptRuns::ReadDone done) {
  const auto run = std::make_shared<ReadRun>();
  writer_.submit(
      [run, key, present, runs = folder_, enough = enough()] { *run = kept_run(runs, key, present, enough); },
      [run, done] { done(*run); }, [done] { done(unread("no memory")); });
}

void StoredRuns::report(const std::string& key, const api::RunRow& present,
                        std::vector<api::ReportDetail> reports, std::vector<api::ColourRow> colours,
                        api::KeptRuns::ReportDone done) {
  const auto html = std::make_shared<icd::Checked<std::string>>();
  writer_.submit(
      [html, key, present, runs = folder_, enough = enough(), reports = std::move(reports),
       colours = std::move(colours)] {
        const auto run = kept_run(runs, key, present, enough);
        if (!run) {
          *html = std::unexpected(run.error());
          return;
        }
        (*run)->colours = colours;
        *html = run_report(**run, reports);
      },
      [html, done] { done(std::move(*html)); }, [done] { done(unread("no memory")); });
}

void StoredRuns::remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) {
  const auto outcome = std::make_shared<std::expected<void, std::string>>(std::unexpected("no memory"));
  writer_.submit([outcome, key, runs = folder_]() mutable { *outcome = runs.remove(key); },
                 [this, key, outcome, done = std::move(done)] {
                   if (*outcome)
                     std::erase_if(list_.runs, [&](const api::RunRow& row) { return row.key == key; });
                   done(*outcome);
                 });
}

Archive::Archive(loop::Loop& loop, const std::string& state_folder)
    : loop_(loop), queue_(loop), writer_(loop), stored_(writer_, RunsFolder(state_folder)) {}

struct Archive::OpenedRun {
  Head head;
  std::expected<std::string, std::string> key = std::unexpected("no memory");
  std::shared_ptr<RunFolder> folder;
  std::optional<RunRecords> told;

  /// Finds or creates the run's directory. Blocks on the disk.
  void open_folder(RunsFolder& runs) {
    key = runs.begin(head);
    if (key) folder = std::make_shared<RunFolder>(runs.folder_of(*key), head);
  }
};

void Archive::begin(const Head& head, GoOn go_on) {
  ++begins_;
  begun_ = PendingRead{.go_on = std::move(go_on)};
  present_ = {};
  present_.head = head;
  samples_.clear();
  attention_.clear();
  queue_.begin();
  const auto opening = std::make_shared<OpenedRun>();
  opening->head = head;
  writer_.submit(
      [opening, runs = stored_.folder(), enough = stored_.enough(), most = limits_.all]() mutable {
        opening->open_folder(runs);
        if (!opening->key) return;
        runs.tidy(most, *opening->key);
        opening->told.emplace(picture::Mosaic::kBudget);
        read_all(runs, *opening->key, *opening->told, enough);
      },
      [this, opening, begins = begins_] {
        if (begins == begins_) on_opened(*opening);
      });
}

void Archive::on_opened(OpenedRun& opening) {
  PendingRead begun = *std::exchange(begun_, std::nullopt);
  if (!opening.told) opening.told.emplace(0);
  on_folder_open(opening);
  RunRecords& told = *opening.told;
  told.move(begun.moved);
  samples_ = std::move(told.samples());
  attention_.restore(samples_.history_after(0).attention);
  const auto wiped = told.picture().wipe_time();
  const auto tracks = told.tracks();
  queue_.restore(told, tracks, wiped, begun.go_on(std::move(told.picture()), tracks));
  next_write_ = loop_.now();
  stored_.refresh();
}

/// A run without a directory is not written.
void Archive::on_folder_open(const OpenedRun& opening) {
  if (opening.key) {
    present_.key = *opening.key;
    present_.folder = opening.folder;
    trouble_.clear();
  } else if (std::exchange(trouble_, opening.key.error()) != opening.key.error()) {
    host::log(host::Level::Warning, "cannot store the run's map and tracks", {{"why", trouble_}});
  }
}

void Archive::make_folder() {
  next_write_ = loop_.now() + kWriteEvery;
  const auto opening = std::make_shared<OpenedRun>();
  opening->head = present_.head;
  ++writing_;
  writer_.submit([opening, runs = stored_.folder()]() mutable { opening->open_folder(runs); },
                 [this, opening, begins = begins_] {
                   --writing_;
                   if (begins == begins_) on_folder_open(*opening);
                 });
}

void Archive::move(double seconds) {
  samples_.move(seconds);
  present_.row.last += seconds;
  if (begun_) begun_->moved += seconds;
  queue_.move(seconds);
}

namespace {

/// Makes every changed tile due.
constexpr double kNoneRests = std::numeric_limits<double>::infinity();

}  // namespace

void Archive::tick(const RunSnapshot& seen) {
  if (begun_) return;
  if (samples_.is_due(seen.now)) samples_.add(queue_.add(seen.sample()));
  note(seen);
  if (writing_ > 0 || loop_.now() < next_write_) return;
  if (present_.folder) {
    queue_.add_poses(seen);
    write(seen, queue_.allowance().at(loop_.now()), seen.stamp);
  } else if (!trouble_.empty()) {
    make_folder();
  }
}

void Archive::write_now(const RunSnapshot& seen) {
  if (begun_ || !present_.folder) return;
  note(seen);
  queue_.add_poses(seen);
  queue_.make_due();
  write(seen, queue_.allowance().at(loop_.now()), kNoneRests);
}

void Archive::end_run(const RunSnapshot& seen) {
  if (begun_ || !present_.folder) return;
  queue_.add_poses(seen);
  queue_.make_due();
  const Allowance of_the_next = queue_.allowance();
  while (write(seen, static_cast<std::size_t>(Allowance::kMost), kNoneRests)) {
  }
  queue_.allowance() = of_the_next;
}

void Archive::note(const RunSnapshot& seen) {
  present_.row = seen.facts();
  present_.row.key = present_.key;
  present_.row.last = seen.now;
  present_.row.stamp = seen.stamp;
}

/// False: no data was due.
bool Archive::write(const RunSnapshot& seen, std::size_t most, double tiles_of) {
  next_write_ = loop_.now() + kWriteEvery;
  auto write = queue_.next(seen, present_.row, most, tiles_of);
  if (!write) return false;
  ++writing_;
  writer_.submit(
      [write, folder = present_.folder, limit = limits_.run] {
        if (write->goes) folder->remove_first(*write->goes);
        write->outcome = folder->write(write->batch, limit);
      },
      [this, write, begins = begins_] {
        --writing_;
        if (begins == begins_) return on_written(*write);
        if (!write->outcome)
          host::log(host::Level::Warning, "cannot store the end of the previous run",
                    {{"why", write->outcome.error()}});
      });
  return true;
}

void Archive::on_written(const Write& write) {
  const std::string why = write.outcome ? "" : write.outcome.error();
  if (std::exchange(trouble_, why) != why && !why.empty())
    host::log(host::Level::Warning, "cannot store the run's map and tracks", {{"why", why}});
  queue_.on_written(write, limits_.run);
  if (write.outcome && !stored_.resize(present_.key, write.outcome->bytes)) stored_.refresh();
}

void Archive::set_attention(const std::vector<std::string>& sentences, api::Time now) {
  if (begun_) return;
  for (api::AttentionStep& step : attention_.update(sentences, now)) {
    queue_.add(record_of(step), true);
    samples_.add(std::move(step));
  }
}

api::RunList Archive::list() const {
  api::RunList all{
      .runs = stored_.list().runs, .bytes = 0, .trouble = trouble_, .unreadable = stored_.list().unreadable};
  // a new run has no files yet
  if (!present_.key.empty() &&
      std::ranges::find(all.runs, present_.key, &api::RunRow::key) == all.runs.end()) {
    all.runs.insert(all.runs.begin(), {.key = present_.key,
                                       .run = present_.head.run,
                                       .post = present_.head.post,
                                       .began = present_.head.began,
                                       .last = loop_.wall_now(),
                                       .stamp = loop_.stamp_now()});
  }
  for (api::RunRow& row : all.runs) {
    row = with_times(row, present_.row);
    row.is_present = row.key == present_.key;
    all.bytes += row.bytes;
  }
  return all;
}

void Archive::remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) {
  if (key == present_.key) return done(std::unexpected("the present run cannot be deleted"));
  stored_.remove(key, std::move(done));
}

}  // namespace adit::archive
