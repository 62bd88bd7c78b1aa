#include "archive/stored_runs.hpp"

#include <algorithm>
#include <utility>

#include "archive/run_records.hpp"
#include "archive/run_report.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::archive {

void read_all(const RunsFolder& runs, const std::string& key, RunRecords& told,
              const std::function<bool()>& enough) {
  const auto all_read = read_run(runs.folder_of(key), told, enough);
  if (all_read && told.damaged() == 0) return;
  const std::string why = all_read ? icd::sentence("damaged records: ", told.damaged()) : all_read.error();
  host::log(host::Level::Error, "a part of a stored run is lost; the rest is used",
            {{"run", key}, {"why", why}});
  told.samples().add(api::AttentionStep{told.last(), true,
                                        "a part of the run's stored map, tracks and plots is lost: " + why});
}

api::RunRow with_times(const api::RunRow& row, const api::RunRow& present) {
  api::RunRow told = row.key == present.key ? present : row;
  told.bytes = row.bytes;
  if (told.began > 0 && told.stamp) told.began += told.last - *told.stamp;
  return told;
}

StoredRuns::StoredRuns(loop::Writer& writer, RunsFolder folder)
    : writer_(writer), folder_(std::move(folder)) {
  look();
}

StoredRuns::~StoredRuns() {
  *ending_ = true;
}

std::function<bool()> StoredRuns::enough() const {
  return [ending = ending_] { return ending->load(); };
}

void StoredRuns::look() {
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
  RunRecords told(StoredRuns::kLookedAt);
  read_all(runs, key, told, enough);
  return std::make_shared<api::KeptRun>(api::KeptRun{with_times(facts, present), std::move(told.picture()),
                                                     told.tracks(), told.samples().since(0)});
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

}  // namespace adit::archive
