#include "journal/journal.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <memory>
#include <utility>

#include "host/files.hpp"
#include "host/log.hpp"

namespace adit::journal {

Journal::Journal(loop::Loop& loop, std::string folder) : folder_(std::move(folder)), compactor_(loop, 1) {
  const auto last = folder_.last();
  number_ = last.value_or(0);
  if (!last) unread_ = last.error();
}

Journal::~Journal() {
  ending_ = true;
}

Carried Journal::read() {
  auto carried = folder_.read();
  if (!carried) unread_ = carried.error();
  if (!unread_.empty()) (void)failed(unread_);
  return unread_.empty() ? std::move(*carried) : Carried();
}

void Journal::begin(const Clock& clock) {
  const std::uint64_t last = number_;
  if (unread_.empty() && open_next() && last > 0) compact(last);
  note(Kind::LifeBegins, {});
  note(Kind::Clock, said(clock));
}

/// Never a file of an earlier life: its last record may be torn.
bool Journal::open_next() {
  const std::string path = folder_.journal(number_ + 1);
  loop::FileDescriptor next(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0600));
  if (!next) {
    (void)failed(host::trouble(path, errno));
    return false;
  }
  ++number_;
  size_ = 0;
  file_ = std::move(next);
  return true;
}

Journal::Kept Journal::accepted(std::span<const lanes::PostedPose> poses) {
  return append(framed(Kind::Poses, said(poses)));
}

/// All in one write.
void Journal::senders(const lanes::StampShift::Clocks& clocks) {
  std::string records;
  for (const auto& [stamper, clock] : clocks) records += framed(Kind::Sender, said(stamper, clock));
  if (!records.empty()) keep(Kind::Sender, std::move(records));
}

void Journal::state_sent(const icd::StateUpdate& update) {
  std::vector<icd::RobotName> robots;
  robots.reserve(update.poses.size());
  for (const icd::NamedPose& pose : update.poses) robots.push_back(pose.name);
  note(Kind::StateSent, said_sent(robots));
}

void Journal::markers_sent(const icd::MarkersUpdate& update) {
  note(Kind::MarkersSent, said_sent(update.markers));
}

void Journal::state_answered(bool done) {
  done ? note(Kind::StateDone, {}) : comes_back(Kind::StateSent, Kind::StateBack);
}

void Journal::markers_answered(bool done) {
  done ? note(Kind::MarkersDone, {}) : comes_back(Kind::MarkersSent, Kind::MarkersBack);
}

void Journal::paced(icd::Uri uri, const pace::Learned& learned) {
  note(Kind::Pace, said(uri, learned));
}

void Journal::stamped(icd::Uri uri, icd::Stamp stamp) {
  note(Kind::Stamp, said(uri, stamp));
}

Journal::Kept Journal::grids_begin() {
  return append(framed(Kind::Grids, std::string_view()));
}

Journal::Kept Journal::grids_posted(const std::string& name, const lanes::Extent& extent) {
  return append(framed(Kind::Grids, said(name, extent)));
}

void Journal::keep(Kind kind, std::string record) {
  if (append(record) || unsaid_size_ + record.size() > kMostUnsaid) return;
  unsaid_size_ += record.size();
  unsaid_.push_back({kind, std::move(record)});
}

void Journal::comes_back(Kind sent, Kind back) {
  const auto last = std::find_if(unsaid_.rbegin(), unsaid_.rend(),
                                 [&](const Unsaid& unsaid) { return unsaid.kind == sent; });
  if (last == unsaid_.rend()) return note(back, {});
  unsaid_size_ -= last->record.size();
  unsaid_.erase(std::next(last).base());
}

std::string Journal::unsaid_and(const std::string& record) const {
  std::string bytes;
  bytes.reserve(unsaid_size_ + record.size());
  for (const Unsaid& unsaid : unsaid_) bytes += unsaid.record;
  return bytes += record;
}

Journal::Kept Journal::append(const std::string& record) {
  if (!unread_.empty()) return std::unexpected(unread_);
  if (!file_ && !open_next()) return std::unexpected(trouble_);
  if (auto written = unsaid_.empty() ? write(record) : write(unsaid_and(record)); !written) return written;
  unsaid_.clear();
  unsaid_size_ = 0;
  trouble_.clear();
  if (size_ > std::max(least_, snapshot_)) turn_over();
  return {};
}

/// All of it or nothing: a record that is half there would end the file for who reads it.
Journal::Kept Journal::write(std::string_view bytes) {
  ssize_t count = -1;
  do {
    count = ::write(file_.get(), bytes.data(), bytes.size());
  } while (count < 0 && errno == EINTR);
  if (count == static_cast<ssize_t>(bytes.size())) {
    size_ += bytes.size();
    return {};
  }
  const int error = count < 0 ? errno : ENOSPC;
  if (count > 0 && ::ftruncate(file_.get(), static_cast<off_t>(size_)) != 0) file_ = {};
  return failed(host::trouble(folder_.journal(number_), error));
}

Journal::Kept Journal::failed(const std::string& why) {
  if (trouble_.empty()) {
    host::log(host::Level::Error, "states and markers cannot be stored; rejecting them", {{"why", why}});
  }
  trouble_ = why;
  return std::unexpected(why);
}

/// What was written so far becomes a snapshot, aside, while the next file is written.
void Journal::turn_over() {
  const std::uint64_t last = number_;
  if (!compacting_ && open_next()) compact(last);
}

void Journal::compact(std::uint64_t last) {
  compacting_ = true;
  auto outcome = std::make_shared<std::expected<std::size_t, std::string>>(std::unexpected("no memory"));
  compactor_.submit(
      loop::Urgency::CanWait, [this, outcome, last] { *outcome = folder_.compact(last, ending_); },
      [this, outcome] {
        compacting_ = false;
        least_ = kLeastTurn;
        if (*outcome) {
          snapshot_ = **outcome;
          return;
        }
        host::log(host::Level::Warning, "cannot compact the journal", {{"why", outcome->error()}});
        least_ = size_ + kLeastTurn;  // to be tried again after as much
      });
}

}  // namespace adit::journal
