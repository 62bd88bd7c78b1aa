#include "journal/journal.hpp"

#include <algorithm>
#include <iterator>
#include <memory>
#include <utility>

#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/try.hpp"
#include "store/log.hpp"

namespace adit::journal {
namespace {

/// Writes a snapshot of all records before log `before`. Returns its size in bytes.
store::Result<std::size_t> write_snapshot(const store::Directory& directory, store::Snapshot& snapshot,
                                          std::uint64_t before, const std::atomic<bool>& enough) {
  const auto contents = ADIT_TRY(store::Contents::read(directory, Journal::kKeeping, before));
  store::Result<void> written;
  read_records(contents).first.write([&](Kind kind, std::string_view said) {
    if (written && !enough) written = snapshot.add(static_cast<std::uint8_t>(kind), said);
  });
  if (enough) return std::unexpected(store::Error{.what = "aditd is stopping"});
  if (written) written = snapshot.finish();
  if (!written) return std::unexpected(written.error());
  return snapshot.bytes();
}

}  // namespace

Journal::Journal(loop::Loop& loop, std::string folder) : path_(std::move(folder)), compactor_(loop, 1) {
  if (const auto opened = open(); !opened) unread_ = opened.error();
}

Journal::~Journal() {
  ending_ = true;
}

Journal::Kept Journal::open() {
  auto directory = store::Directory::lock(path_);
  if (!directory) return std::unexpected(directory.error().what);
  auto contents = store::Contents::read(*directory, kKeeping);
  if (!contents) return std::unexpected(contents.error().what);
  directory_ = std::move(*directory);
  contents_ = std::move(*contents);
  return {};
}

bool Journal::can_be_read(const std::string& folder) {
  if (!host::may_exist(folder)) return true;
  const auto directory = store::Directory::look(folder);
  return directory && store::Contents::read(*directory, kKeeping);
}

Carried Journal::read() {
  if (!contents_) {
    (void)failed(unread_);
    return {};
  }
  auto [carried, damage] = read_records(*contents_);
  damage_ = std::move(damage);
  if (!damage_.empty()) host::log(host::Level::Error, damage_);
  return std::move(carried);
}

/// Compacts the files of earlier processes into a snapshot.
void Journal::begin(const Clock& clock) {
  if (contents_) {
    log_.emplace(*directory_, kKeeping);
    const bool is_first = contents_->is_new;
    const auto started = log_->start(*contents_);
    contents_.reset();
    if (!started) (void)failed(started.error().what);
    if (!is_first) compact();
  }
  note(Kind::LifeBegins, {});
  note(Kind::Clock, store::bytes_of(clock));
}

void Journal::senders(const queues::StampShift::Clocks& clocks) {
  if (!clocks.empty()) note(Kind::Senders, store::bytes_of(clocks));
}

Journal::Kept Journal::accepted(const icd::MarkersUpdate& update) {
  for (const std::string& record : records_of(update.markers)) {
    if (auto kept = accepted_markers(record); !kept) return kept;
  }
  return {};
}

void Journal::state_answered(bool done) {
  if (done) return note(Kind::StateDone, {});
  comes_back(Kind::StateSent, Kind::StateBack);
}

void Journal::markers_answered(bool done) {
  if (done) return note(Kind::MarkersDone, {});
  comes_back(Kind::MarkersSent, Kind::MarkersBack);
}

void Journal::note(Kind kind, std::string said) {
  if (append(kind, said) || unsaid_size_ + said.size() > kMostUnsaid) return;
  unsaid_size_ += said.size();
  unsaid_.push_back({kind, std::move(said)});
}

void Journal::comes_back(Kind sent, Kind back) {
  const auto last = std::find_if(unsaid_.rbegin(), unsaid_.rend(),
                                 [&](const Unsaid& unsaid) { return unsaid.kind == sent; });
  if (last == unsaid_.rend()) return note(back, {});
  unsaid_size_ -= last->said.size();
  unsaid_.erase(std::next(last).base());
}

/// If the directory could not be opened at the start, tries again. Records found in it then were not read, so
/// append() fails.
Journal::Kept Journal::append(Kind kind, std::string_view said) {
  if (!log_) {
    if (!contents_) {
      if (auto opened = open(); !opened) return failed(opened.error());
    }
    if (!contents_->is_new) return failed(unread_);
    unread_.clear();
    log_.emplace(*directory_, kKeeping);
    if (auto started = log_->start(*contents_); !started) return failed(started.error().what);
  }
  if (auto said_before = append_unsaid(); !said_before) return said_before;
  if (auto written = write(kind, said); !written) return written;
  trouble_.clear();
  if (size_ > std::max(least_, snapshot_)) compact();
  return {};
}

Journal::Kept Journal::append_unsaid() {
  for (auto unsaid = unsaid_.begin(); unsaid != unsaid_.end(); unsaid = unsaid_.erase(unsaid)) {
    if (auto written = write(unsaid->kind, unsaid->said); !written) return written;
    unsaid_size_ -= unsaid->said.size();
  }
  return {};
}

Journal::Kept Journal::write(Kind kind, std::string_view said) {
  const auto written = log_->append(static_cast<std::uint8_t>(kind), said, store::Durability::Now);
  if (!written) return failed(written.error().what);
  size_ += store::room_of(said.size(), store::kInMemory);
  return {};
}

Journal::Kept Journal::failed(const std::string& why) {
  if (trouble_.empty()) {
    host::log(host::Level::Error, "states and markers cannot be stored; rejecting them", {{"why", why}});
  }
  trouble_ = why;
  return std::unexpected(why);
}

/// Compacts all records so far, while new ones go to the next file.
void Journal::compact() {
  if (compacting_) return;
  if (const auto turned = log_->turn(); !turned) return not_compacted(turned.error());
  size_ = 0;
  auto begun = store::Snapshot::begin(*directory_, kKeeping, *log_);
  if (!begun) return not_compacted(begun.error());
  compacting_ = true;
  const auto snapshot = std::make_shared<store::Snapshot>(std::move(*begun));
  const auto outcome = std::make_shared<store::Result<std::size_t>>();
  compactor_.submit(
      loop::Urgency::CanWait,
      [this, snapshot, outcome, before = log_->number()] {
        *outcome = write_snapshot(*directory_, *snapshot, before, ending_);
      },
      [this, outcome] {
        compacting_ = false;
        if (!*outcome) return not_compacted(outcome->error());
        least_ = kLeastTurn;
        snapshot_ = **outcome;
      });
}

/// Retries after kLeastTurn more bytes.
void Journal::not_compacted(const store::Error& error) {
  host::log(host::Level::Warning, "cannot compact the journal", {{"why", error.what}});
  least_ = size_ + kLeastTurn;
}

}  // namespace adit::journal
