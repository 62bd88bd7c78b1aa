#include "archive/archive.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "codec/row_file.hpp"
#include "host/log.hpp"

namespace adit::archive {

Archive::Archive(loop::Loop& loop, const std::string& state_folder)
    : loop_(loop), writer_(loop), stored_(writer_, RunsFolder(state_folder)) {
  stored_.look();
}

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
      [opening, runs = stored_.folder(), enough = stored_.enough(), most = limits_.all]() mutable {
        opening->key = runs.begin(opening->head);
        if (!opening->key) return;
        runs.tidy(most, *opening->key);
        opening->folder = std::make_shared<RunFolder>(runs.folder_of(*opening->key), opening->head);
        opening->told.emplace(picture::Mosaic::kBudget);
        read_all(runs, *opening->key, *opening->told, enough);
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
  stored_.look();
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
      [opening, runs = stored_.folder()]() mutable {
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

api::RunList Archive::list() const {
  api::RunList all{
      .runs = stored_.list().runs, .bytes = 0, .trouble = trouble_, .unreadable = stored_.list().unreadable};
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
    row = with_times(row, row_);
    row.is_present = row.key == key_;
    all.bytes += row.bytes;
  }
  return all;
}

void Archive::remove(const std::string& key, std::function<void(std::expected<void, std::string>)> done) {
  if (key == key_) return done(std::unexpected("the present run cannot be deleted"));
  stored_.remove(key, std::move(done));
}

}  // namespace adit::archive
