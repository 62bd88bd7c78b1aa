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

constexpr std::size_t kRecordBytes =
    1u << 20;  // of markers, as in icd::bytes_of; store::kMostBody holds any marker

bool is_known(icd::Uri uri) {
  return std::ranges::find(icd::kUris, uri) != std::end(icd::kUris);
}
bool is_known(const std::string& /*name*/) {
  return true;
}

/// Stores a record's key and value.
template <class Key, class Value>
bool read_into(std::map<Key, Value>& all, std::string_view said) {
  Key key{};
  Value value{};
  if (!store::read(said, key, value) || !is_known(key)) return false;
  all[key] = value;
  return true;
}

}  // namespace

bool HandoverState::apply(RecordKind kind, std::string_view said) {
  switch (kind) {
    case RecordKind::Clock:
      return read_clock(said);
    case RecordKind::LifeBegins:
      put_back_state(), put_back_markers();
      return true;
    case RecordKind::Senders:
      return read_senders(said);
    case RecordKind::StateSent:
      return read_state_sent(said);
    case RecordKind::StateDone:
      on_state_done();
      return true;
    case RecordKind::StateBack:
      put_back_state();
      return true;
    case RecordKind::Markers:
      return read_markers(said);
    case RecordKind::MarkersSent:
      return read_sent(said);
    case RecordKind::MarkersDone:
      markers_under_way_.clear();
      return true;
    case RecordKind::MarkersBack:
      put_back_markers();
      return true;
    case RecordKind::Pace:
      return read_into(paces_, said);
    case RecordKind::Stamp:
      return read_into(stamps_, said);
    case RecordKind::Grids:
      if (!grids_) grids_.emplace();
      return said.empty() || read_into(*grids_, said);  // an empty one begins them
    case RecordKind::Poses:
      return read_poses(said);
    case RecordKind::Heard:
      return read_heard(said);
  }
  return false;
}

bool HandoverState::read_clock(std::string_view said) {
  Clock clock;
  if (!store::read(said, clock)) return false;
  set_boot(clock.boot);
  clock_ = std::move(clock);
  return true;
}

void HandoverState::set_boot(const std::string& boot) {
  if (!clock_ || clock_->boot == boot) return;
  clock_.reset();
  paces_.clear();
  senders_ = {};
  heard_.clear();
}

bool HandoverState::read_senders(std::string_view said) {
  queues::StampShift::Clocks clocks;
  if (!store::read(said, clocks)) return false;
  for (const auto& [stamper, clock] : clocks) {
    if (!is_known(stamper.uri)) return false;
    senders_.restore(stamper, clock);
  }
  return true;
}

/// queues::StateQueue::news_in() has kept only the newest poses.
bool HandoverState::read_poses(std::string_view said) {
  std::vector<std::tuple<std::string, std::string, std::optional<icd::Stamp>, icd::Pose>> read;
  if (!store::read(said, read)) return false;
  std::vector<queues::PostedPose> poses;
  poses.reserve(read.size());
  for (auto& [text, address, stamp, pose] : read) {
    auto name = icd::RobotName::parse(text);
    if (!name) return false;
    poses.push_back({*std::move(name), pose, stamp, std::move(address)});
  }
  for (queues::PostedPose& posted : poses) {
    if (posted.stamp && !posted.address.empty())
      senders_.restore_stamp({posted.address, icd::Uri::StateUpdate, posted.name.text()}, *posted.stamp);
    const auto known = robots_.find(posted.name);
    if (known == robots_.end()) {
      robots_.emplace(posted.name, Robot{posted});
    } else {
      known->second.posted = std::move(posted);
      known->second.news = true;
    }
  }
  return true;
}

/// One state is in flight at a time, so an earlier one without an answer was not delivered.
bool HandoverState::read_state_sent(std::string_view said) {
  std::vector<std::string> robots;
  if (!store::read(said, robots)) return false;
  put_back_state();
  for (const std::string& robot : robots) {
    const auto name = icd::RobotName::parse(robot);
    const auto held = name ? robots_.find(*name) : robots_.end();
    if (held != robots_.end()) held->second.under_way = std::exchange(held->second.news, false);
  }
  return true;
}

bool HandoverState::read_markers(std::string_view said) {
  std::vector<icd::Marker> markers;
  if (!store::read(said, markers)) return false;
  for (icd::Marker& marker : markers) markers_.apply(std::move(marker));
  return true;
}

/// The sent markers are among the queued ones; newer changes follow. Unanswered earlier markers queue again.
bool HandoverState::read_sent(std::string_view said) {
  std::vector<std::tuple<std::string, std::int32_t, icd::MarkerAction>> sent;
  if (!store::read(said, sent)) return false;
  put_back_markers();
  markers_under_way_.clear();
  icd::Marker like;
  for (auto& [ns, id, action] : sent) {
    like.ns = std::move(ns), like.id = id, like.action = action;
    if (auto marker = markers_.remove(like)) markers_under_way_.push_back(std::move(*marker));
  }
  return true;
}

bool HandoverState::read_heard(std::string_view said) {
  Heard heard;
  const auto of_earlier_version = [said] { return std::string(said) + store::bytes_of(Heard().behind); };
  if (!store::read(said, heard) && !store::read(of_earlier_version(), heard)) return false;
  heard_[heard.robot] = heard;
  return true;
}

double HandoverState::lag(const std::string& robot, std::size_t kind) const {
  const auto heard = heard_.find(robot);
  return heard == heard_.end() ? Heard::kNever : heard->second.behind.at(kind);
}

void HandoverState::on_state_done() {
  for (auto& [name, robot] : robots_) robot.under_way = false;
  std::erase_if(robots_, [](const auto& robot) { return !robot.second.news; });
}

void HandoverState::put_back_state() {
  for (auto& [name, robot] : robots_) robot.news = std::exchange(robot.under_way, false) || robot.news;
}

/// As queues::MarkerQueue::put_back().
void HandoverState::put_back_markers() {
  queues::MarkerChanges older;
  for (icd::Marker& marker : std::exchange(markers_under_way_, {})) older.apply(std::move(marker));
  markers_.apply_before(std::move(older));
}

icd::MarkersUpdate HandoverState::markers() const {
  HandoverState ended = *this;
  ended.put_back_markers();
  icd::MarkersUpdate update;
  update.markers.reserve(ended.markers_.size().count);
  for (const auto& [place, marker] : ended.markers_.changes_by_place()) update.markers.push_back(marker);
  return update;
}

void HandoverState::write(const std::function<void(RecordKind, std::string_view)>& to) const {
  if (clock_) to(RecordKind::Clock, store::bytes_of(*clock_));
  to(RecordKind::Senders, store::bytes_of(senders_.clocks()));
  for (const auto& [uri, learned] : paces_) to(RecordKind::Pace, store::bytes_of(uri, learned));
  for (const auto& [uri, stamp] : stamps_) to(RecordKind::Stamp, store::bytes_of(uri, stamp));
  if (grids_) {
    to(RecordKind::Grids, {});
    for (const auto& [key, extent] : *grids_) to(RecordKind::Grids, store::bytes_of(key, extent));
  }
  for (const auto& [robot, heard] : heard_) to(RecordKind::Heard, store::bytes_of(heard));
  const auto write_robots = [&](bool Robot::* these) {
    std::vector<icd::RobotName> names;
    for (const auto& [name, robot] : robots_) {
      if (!(robot.*these)) continue;
      to(RecordKind::Poses, store::bytes_of(std::span(&robot.posted, 1)));
      names.push_back(name);
    }
    return names;
  };
  to(RecordKind::StateSent, store::bytes_of(write_robots(&Robot::under_way)));
  write_robots(&Robot::news);
  const auto write_markers = [&to](std::span<const icd::Marker> markers) {
    for (const std::string& record : records_of(markers)) to(RecordKind::Markers, record);
  };
  write_markers(markers_under_way_);
  to(RecordKind::MarkersSent, names_of(markers_under_way_));
  std::vector<icd::Marker> waiting;
  for (const auto& [place, marker] : markers_.changes_by_place()) waiting.push_back(marker);
  write_markers(waiting);
}

std::pair<HandoverState, std::string> read_records(const store::Contents& contents) {
  HandoverState carried;
  std::string damage;
  std::size_t unknown = 0;
  for (const store::Item& item : contents.items) {
    if (const auto* const gap = std::get_if<store::Gap>(&item)) {
      damage = "records of the journal are missing: " + gap->file;
      continue;
    }
    const auto& record = std::get<store::Record>(item);
    RecordKind kind{record.kind};
    if (!damage.empty() && kind == RecordKind::StateDone) kind = RecordKind::StateBack;
    if (!damage.empty() && kind == RecordKind::MarkersDone) kind = RecordKind::MarkersBack;
    if (!carried.apply(kind, record.body)) ++unknown;
  }
  if (unknown > 0) {
    host::log(host::Level::Error, "unknown journal records skipped", {{"records", std::to_string(unknown)}});
  }
  return {std::move(carried), std::move(damage)};
}

std::vector<std::string> records_of(std::span<const icd::Marker> markers) {
  std::vector<std::string> records;
  do {
    std::size_t count = 0, bytes = 0;
    while (count < markers.size() && bytes < kRecordBytes) bytes += icd::bytes_of(markers[count++]);
    records.push_back(store::bytes_of(markers.first(count)));
    markers = markers.subspan(count);
  } while (!markers.empty());
  return records;
}

std::string names_of(std::span<const icd::Marker> markers) {
  store::Writer put;
  put(markers.size());
  for (const icd::Marker& marker : markers) {
    const auto name = std::tie(marker.ns, marker.id, marker.action);
    store::walk(put, name);
  }
  return put.finish();
}

namespace {

/// Writes a snapshot of all records before log `before`. Returns its size in bytes.
store::Result<std::size_t> write_snapshot(const store::Directory& directory, store::Snapshot& snapshot,
                                          std::uint64_t before, const std::atomic<bool>& enough) {
  const auto contents = ADIT_TRY(store::Contents::read(directory, Journal::kKeeping, before));
  store::Result<void> written;
  read_records(contents).first.write([&](RecordKind kind, std::string_view said) {
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
  if (!host::can_exist(folder)) return true;
  const auto directory = store::Directory::open(folder);
  return directory && store::Contents::read(*directory, kKeeping);
}

HandoverState Journal::read() {
  if (!contents_) {
    (void)on_failed(unread_);
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
    if (!started) (void)on_failed(started.error().what);
    if (!is_first) compact();
  }
  note(RecordKind::LifeBegins, {});
  note(RecordKind::Clock, store::bytes_of(clock));
}

void Journal::record_senders(const queues::StampShift::Clocks& clocks) {
  if (!clocks.empty()) note(RecordKind::Senders, store::bytes_of(clocks));
}

Journal::Kept Journal::record_accepted(const icd::MarkersUpdate& update) {
  for (const std::string& record : records_of(update.markers)) {
    if (auto kept = accepted_markers(record); !kept) return kept;
  }
  return {};
}

void Journal::record_state_answered(bool done) {
  if (done) return note(RecordKind::StateDone, {});
  record_return(RecordKind::StateSent, RecordKind::StateBack);
}

void Journal::record_markers_answered(bool done) {
  if (done) return note(RecordKind::MarkersDone, {});
  record_return(RecordKind::MarkersSent, RecordKind::MarkersBack);
}

void Journal::note(RecordKind kind, std::string said) {
  if (append(kind, said) || unsaid_size_ + said.size() > kMostUnsaid) return;
  unsaid_size_ += said.size();
  unsaid_.push_back({kind, std::move(said)});
}

void Journal::record_return(RecordKind sent, RecordKind back) {
  const auto last = std::find_if(unsaid_.rbegin(), unsaid_.rend(),
                                 [&](const PendingRecord& unsaid) { return unsaid.kind == sent; });
  if (last == unsaid_.rend()) return note(back, {});
  unsaid_size_ -= last->said.size();
  unsaid_.erase(std::next(last).base());
}

/// If the directory could not be opened at the start, tries again. Records found in it then were not read, so
/// append() fails.
Journal::Kept Journal::append(RecordKind kind, std::string_view said) {
  if (!log_) {
    if (!contents_) {
      if (auto opened = open(); !opened) return on_failed(opened.error());
    }
    if (!contents_->is_new) return on_failed(unread_);
    unread_.clear();
    log_.emplace(*directory_, kKeeping);
    if (auto started = log_->start(*contents_); !started) return on_failed(started.error().what);
  }
  if (auto said_before = append_pending(); !said_before) return said_before;
  if (auto written = write(kind, said); !written) return written;
  trouble_.clear();
  if (size_ > std::max(least_, snapshot_)) compact();
  return {};
}

Journal::Kept Journal::append_pending() {
  for (auto unsaid = unsaid_.begin(); unsaid != unsaid_.end(); unsaid = unsaid_.erase(unsaid)) {
    if (auto written = write(unsaid->kind, unsaid->said); !written) return written;
    unsaid_size_ -= unsaid->said.size();
  }
  return {};
}

Journal::Kept Journal::write(RecordKind kind, std::string_view said) {
  const auto written = log_->append(static_cast<std::uint8_t>(kind), said, store::Durability::Now);
  if (!written) return on_failed(written.error().what);
  size_ += store::room_of(said.size(), store::kInMemory);
  return {};
}

Journal::Kept Journal::on_failed(const std::string& why) {
  if (trouble_.empty()) {
    host::log(host::Level::Error, "states and markers cannot be stored; rejecting them", {{"why", why}});
  }
  trouble_ = why;
  return std::unexpected(why);
}

/// Compacts all records so far, while new ones go to the next file.
void Journal::compact() {
  if (compacting_) return;
  if (const auto turned = log_->turn(); !turned) return on_compaction_failed(turned.error());
  size_ = 0;
  auto begun = store::Snapshot::begin(*directory_, kKeeping, *log_);
  if (!begun) return on_compaction_failed(begun.error());
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
        if (!*outcome) return on_compaction_failed(outcome->error());
        least_ = kLeastTurn;
        snapshot_ = **outcome;
      });
}

/// Retries after kLeastTurn more bytes.
void Journal::on_compaction_failed(const store::Error& error) {
  host::log(host::Level::Warning, "cannot compact the journal", {{"why", error.what}});
  least_ = size_ + kLeastTurn;
}

}  // namespace adit::journal
