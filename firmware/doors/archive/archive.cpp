#include "archive/archive.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "archive/run_report.hpp"
#include "codec/row_file.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::archive {

Archive::Archive(loop::Loop& loop, const std::string& state_folder)
    : loop_(loop), runs_(state_folder), writer_(loop) {
  look_at_disk();
}

Archive::~Archive() {
  *ending_ = true;
}

std::function<bool()> Archive::enough() const {
  return [ending = ending_] { return ending->load(); };
}

namespace {

/// Skips unreadable files and damaged records of a run. Reports them in the log and in the run's own list of
/// attention.
void tell_all(const RunsFolder& runs, const std::string& key, RunRecords& told,
              const std::function<bool()>& enough) {
  const auto all_read = read_run(runs.folder_of(key), told, enough);
  if (all_read && told.damaged() == 0) return;
  const std::string why = all_read ? icd::sentence("damaged records: ", told.damaged()) : all_read.error();
  host::log(host::Level::Error, "a part of a stored run is lost; the rest is used",
            {{"run", key}, {"why", why}});
  told.samples().add(api::AttentionStep{told.last(), true,
                                        "a part of the run's stored map, tracks and plots is lost: " + why});
}

}  // namespace

/// Result of opening a run on disk.
struct Archive::Opening {
  Head head;
  std::expected<std::string, std::string> key = std::unexpected("no memory");
  std::shared_ptr<RunFolder> folder;
  std::optional<RunRecords> told;
};

void Archive::begin(const Head& head, GoOn go_on) {
  ++begun_;
  opening_ = true;
  key_.clear();
  folder_.reset();
  go_on_ = std::move(go_on);
  samples_.clear();
  attention_.clear();
  lines_ = {};
  moved_ = 0;
  steps_.clear();
  row_ = {};
  be_due();
  const auto opening = std::make_shared<Opening>();
  opening->head = head;
  writer_.submit(
      [opening, runs = runs_, enough = enough(), most = limits_.all]() mutable {
        opening->key = runs.begin(opening->head);
        if (!opening->key) return;
        runs.tidy(most, *opening->key);
        opening->folder = std::make_shared<RunFolder>(runs.folder_of(*opening->key), opening->head);
        opening->told.emplace(picture::Mosaic::kBudget);
        tell_all(runs, *opening->key, *opening->told, enough);
      },
      [this, opening, begun = begun_] {
        if (begun == begun_) opened(*opening);
      });
}

void Archive::opened(Opening& opening) {
  opening_ = false;
  if (!opening.told) opening.told.emplace(0);
  head_ = opening.head;
  has_folder(opening);
  RunRecords& told = *opening.told;
  told.move(std::exchange(moved_, 0));
  samples_ = std::move(told.samples());
  attention_.go_on(samples_.since(0).attention);
  wiped_ = told.picture().wiped();
  auto tracks = told.tracks();
  poses_ = Poses(tracks);
  const picture::Mosaic& now = std::exchange(go_on_, nullptr)(std::move(told.picture()), std::move(tracks));
  due_.begin(now, told.files());
  layers_seen_ = now.version();
  next_write_ = loop_.now();
  look_at_disk();
}

/// A run without a directory is not written.
void Archive::has_folder(const Opening& opening) {
  if (opening.key) {
    key_ = *opening.key;
    folder_ = opening.folder;
    trouble_.clear();
  } else if (std::exchange(trouble_, opening.key.error()) != opening.key.error()) {
    host::log(host::Level::Warning, "cannot store the run's map and tracks", {{"why", trouble_}});
  }
}

void Archive::make_folder() {
  next_write_ = loop_.now() + kWriteEvery;
  const auto opening = std::make_shared<Opening>();
  opening->head = head_;
  ++writing_;
  writer_.submit(
      [opening, runs = runs_]() mutable {
        opening->key = runs.begin(opening->head);
        if (opening->key)
          opening->folder = std::make_shared<RunFolder>(runs.folder_of(*opening->key), opening->head);
      },
      [this, opening, begun = begun_] {
        --writing_;
        if (begun == begun_) has_folder(*opening);
      });
}

/// Call before other functions use the new time. Keeps only as many lines as one write holds, so that the
/// step goes with them.
void Archive::move(double seconds) {
  samples_.move(seconds);
  poses_.move(seconds);
  row_.last += seconds;
  if (wiped_) *wiped_ += seconds;
  due_.move(seconds);
  if (opening_) moved_ += seconds;
  const Step step{seconds, std::chrono::duration<double>(loop_.now().time_since_epoch()).count()};
  facts_.clear();
  lines_.add(record_of(step), true);
  lines_.keep_below(kLargestRecord);
  steps_ += record_of(step);
}

void Archive::needs_attention(const std::vector<std::string>& sentences, api::Time now) {
  if (opening_) return;
  for (api::AttentionStep& step : attention_.look(sentences, now)) {
    lines_.add(record_of(step), true);
    samples_.add(std::move(step));
  }
}

void Archive::be_due() {
  next_facts_ = loop_.now();
  facts_.clear();
  lines_.be_due();
}

void Archive::look_at_disk() {
  const auto listed = std::make_shared<std::expected<RunsFolder::List, std::string>>();
  writer_.submit([listed, runs = runs_] { *listed = runs.list(); },
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

namespace {

/// The present run's row as it is now, others as on disk. Converts the start from the stamp clock, which the
/// ledger uses, to the time of day, like the end.
api::RunRow as_told(const api::RunRow& row, const api::RunRow& present) {
  api::RunRow told = row.key == present.key ? present : row;
  told.bytes = row.bytes;
  if (told.began > 0 && told.stamp) told.began += told.last - *told.stamp;
  return told;
}

}  // namespace

api::RunList Archive::list() const {
  api::RunList all{.runs = list_.runs, .bytes = 0, .trouble = trouble_, .unreadable = list_.unreadable};
  // a new run has no files yet
  if (!key_.empty() && std::ranges::find(all.runs, key_, &api::RunRow::key) == all.runs.end()) {
    all.runs.insert(all.runs.begin(), {.key = key_,
                                       .run = head_.run,
                                       .post = head_.post,
                                       .began = head_.began,
                                       .last = loop_.wall_now(),
                                       .stamp = loop_.stamp_now()});
  }
  for (api::RunRow& row : all.runs) {
    row = as_told(row, row_);
    row.is_present = row.key == key_;
    all.bytes += row.bytes;
  }
  return all;
}

namespace {

using ReadRun = icd::Checked<std::shared_ptr<api::KeptRun>>;

std::unexpected<icd::Refusal> unread(const std::string& why) {
  return std::unexpected(icd::Refusal{icd::Status::ServiceUnavailable, "cannot read the stored run: " + why});
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
  RunRecords told(Archive::kLookedAt);
  tell_all(runs, key, told, enough);
  return std::make_shared<api::KeptRun>(api::KeptRun{as_told(facts, present), std::move(told.picture()),
                                                     told.tracks(), told.samples().since(0)});
}

}  // namespace

void Archive::read(const std::string& key, ReadDone done) {
  const auto run = std::make_shared<ReadRun>();
  writer_.submit([run, key, present = row_, runs = runs_,
                  enough = enough()] { *run = kept_run(runs, key, present, enough); },
                 [run, done] { done(*run); }, [done] { done(unread("no memory")); });
}

void Archive::report(const std::string& key, std::vector<api::ReportDetail> reports,
                     std::vector<api::ColourRow> colours, ReportDone done) {
  const auto html = std::make_shared<icd::Checked<std::string>>();
  writer_.submit(
      [html, key, present = row_, runs = runs_, enough = enough(), reports = std::move(reports),
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

void Archive::remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) {
  if (key == key_) return done(std::unexpected("the present run cannot be deleted"));
  const auto outcome = std::make_shared<std::expected<void, std::string>>(std::unexpected("no memory"));
  writer_.submit([outcome, key, runs = runs_]() mutable { *outcome = runs.remove(key); },
                 [this, key, outcome, done = std::move(done)] {
                   if (*outcome)
                     std::erase_if(list_.runs, [&](const api::RunRow& row) { return row.key == key; });
                   done(*outcome);
                 });
}

}  // namespace adit::archive
