#include "journal/carried.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "codec/body_decoder.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "host/log.hpp"

namespace adit::journal {
namespace {

/// A snapshot's messages are no larger than those that it is made of.
constexpr std::size_t kMarkersInARecord = 500;

/// By the ICD's own rules: a team's (aliases, frames) were applied before.
std::optional<icd::MarkersUpdate> markers_in(std::string_view said) {
  const auto document = codec::decode({codec::Format::Cbor, codec::ContentCoding::Identity},
                                      codec::Split::Lists, said, {.text_bytes = said.size()});
  auto markers = document ? codec::read_markers_update(*document, {}) : std::unexpected(document.error());
  if (!markers) return std::nullopt;
  return std::move(*markers);
}

std::optional<icd::Uri> uri_in(Reader& reader) {
  const auto uri = static_cast<icd::Uri>(reader.number());
  const bool known = std::ranges::find(icd::kUris, uri) != std::end(icd::kUris);
  return reader.ok() && known ? std::optional(uri) : std::nullopt;
}

pace::Duration duration_in(Reader& reader) {
  return pace::Duration(static_cast<std::int64_t>(reader.number()));
}

/// The components of a pose, in the order of a record.
std::array<double*, 7> parts_of(icd::Pose& pose) {
  auto& [at, turned] = pose;
  return {&at.x, &at.y, &at.z, &turned.x, &turned.y, &turned.z, &turned.w};
}

/// Nothing where they are cut short.
std::optional<std::vector<lanes::PostedPose>> poses_in(Reader& reader) {
  std::vector<lanes::PostedPose> poses;
  while (reader.ok() && !reader.at_end()) {
    const auto name = icd::RobotName::parse(reader.text());
    if (!name) return std::nullopt;
    lanes::PostedPose& posted = poses.emplace_back(*name);
    posted.address = reader.text();
    if (const double stamp = reader.real(); !std::isnan(stamp)) posted.stamp = stamp;
    for (double* const part : parts_of(posted.pose)) *part = reader.real();
  }
  return reader.ok() ? std::optional(std::move(poses)) : std::nullopt;
}

std::uint64_t number_of(pace::Duration duration) {
  return static_cast<std::uint64_t>(std::int64_t{duration.count()});
}

}  // namespace

bool Carried::apply(Kind kind, std::string_view said) {
  switch (kind) {
    case Kind::Clock:
      return read_clock(said);
    case Kind::LifeBegins:
      state_comes_back(), markers_come_back();
      return true;
    case Kind::Sender:
      return read_sender(said);
    case Kind::StateSent:
      return read_state_sent(said);
    case Kind::StateDone:
      state_is_done();
      return true;
    case Kind::StateBack:
      state_comes_back();
      return true;
    case Kind::Markers:
      return read_markers(said);
    case Kind::MarkersSent:
      return read_sent(said);
    case Kind::MarkersDone:
      markers_under_way_.clear();
      return true;
    case Kind::MarkersBack:
      markers_come_back();
      return true;
    case Kind::Pace:
      return read_pace(said);
    case Kind::Stamp:
      return read_stamp(said);
    case Kind::Grids:
      return read_grids(said);
    case Kind::Poses:
      return read_poses(said);
    case Kind::Heard:
      return read_heard(said);
  }
  return false;
}

bool Carried::read_clock(std::string_view said) {
  Reader reader(said);
  Clock clock{.boot = std::string(reader.text()), .at = pace::Instant(duration_in(reader)), .stamp = 0};
  clock.stamp = reader.real();
  if (!reader.at_end()) clock.leapt_to = reader.real(), clock.leapt_by = reader.real();
  if (!reader.at_end()) clock.off = reader.real(), clock.off_since = reader.real();
  if (!reader.ok()) return false;
  machine_is(clock.boot);
  clock_ = std::move(clock);
  return true;
}

void Carried::machine_is(const std::string& boot) {
  if (!clock_ || clock_->boot == boot) return;
  clock_.reset();
  paces_.clear();
  senders_ = {};
  heard_.clear();
}

bool Carried::read_sender(std::string_view said) {
  Reader reader(said);
  lanes::Stamper stamper{.address = std::string(reader.text())};
  const auto uri = uri_in(reader);
  stamper.uri = uri.value_or(stamper.uri);
  stamper.robot = reader.text();
  lanes::SenderClock clock;
  clock.theirs = reader.real();
  clock.ours = reader.real();
  clock.latest = reader.real();
  if (uri && reader.ok()) senders_.carry_on(stamper, clock);
  return uri && reader.ok();
}

/// lanes::StateLane::news_in() has said that they are the newest.
bool Carried::read_poses(std::string_view said) {
  Reader reader(said);
  const auto poses = poses_in(reader);
  if (!poses) return false;
  for (const lanes::PostedPose& posted : *poses) {
    Robot& robot = robots_.try_emplace(posted.name, Robot{posted}).first->second;
    robot.posted = posted;
    robot.news = true;
  }
  return true;
}

/// One state is under way at a time: what was before, and of which no answer is known, was not taken.
bool Carried::read_state_sent(std::string_view said) {
  Reader reader(said);
  state_comes_back();
  for (std::uint64_t left = reader.number(); left > 0 && reader.ok(); --left) {
    const auto name = icd::RobotName::parse(std::string(reader.text()));
    const auto held = name ? robots_.find(*name) : robots_.end();
    if (held != robots_.end()) held->second.under_way = std::exchange(held->second.news, false);
  }
  return reader.ok();
}

bool Carried::read_markers(std::string_view said) {
  const auto update = markers_in(said);
  if (!update) return false;
  for (const icd::Marker& marker : update->markers) markers_.apply(marker);
  return true;
}

/// The markers that went are those that wait now; newer changes of them come later. Those before, of which no
/// answer is known, wait again.
bool Carried::read_sent(std::string_view said) {
  Reader reader(said);
  markers_come_back();
  std::vector<icd::Marker> sent;
  for (std::uint64_t left = reader.number(); left > 0 && reader.ok(); --left) {
    icd::Marker like;
    like.ns = reader.text();
    like.id = static_cast<std::int32_t>(reader.number());
    like.action = static_cast<icd::MarkerAction>(reader.number());
    if (auto marker = markers_.remove(like)) sent.push_back(std::move(*marker));
  }
  markers_under_way_ = std::move(sent);
  return reader.ok();
}

bool Carried::read_pace(std::string_view said) {
  Reader reader(said);
  const auto uri = uri_in(reader);
  pace::Learned learned;
  learned.earliest.first = pace::Instant(duration_in(reader));
  learned.spacing = duration_in(reader);
  learned.under_way = reader.number() != 0;
  const bool is_older = reader.at_end();  // of a version that counted from answers alone
  learned.earliest.last = is_older ? learned.earliest.first : pace::Instant(duration_in(reader));
  const std::uint64_t counting = is_older ? 0 : reader.number();
  learned.from_answers = counting % 2 != 0;
  learned.single = static_cast<int>(std::min<std::uint64_t>(counting / 2, INT32_MAX));
  if (uri && reader.ok()) paces_[*uri] = learned;
  return uri && reader.ok();
}

bool Carried::read_stamp(std::string_view said) {
  Reader reader(said);
  const auto uri = uri_in(reader);
  const double stamp = reader.real();
  if (uri && reader.ok()) stamps_[*uri] = stamp;
  return uri && reader.ok();
}

/// An empty one begins them: what is sent is told from there on.
bool Carried::read_grids(std::string_view said) {
  if (!grids_) grids_.emplace();
  if (said.empty()) return true;
  Reader reader(said);
  const std::string key(reader.text());
  lanes::Extent extent;
  for (double* const side : {&extent.left, &extent.bottom, &extent.right, &extent.top}) *side = reader.real();
  if (reader.ok()) (*grids_)[key] = extent;
  return reader.ok();
}

bool Carried::read_heard(std::string_view said) {
  Reader reader(said);
  Heard heard{.robot = std::string(reader.text()), .messages = reader.number()};
  heard.gap = reader.real();
  heard.last = reader.real();
  for (auto& [accepted, forwarded] : heard.kinds) accepted = reader.real(), forwarded = reader.real();
  if (reader.ok()) heard_[heard.robot] = heard;
  return reader.ok();
}

void Carried::state_is_done() {
  for (auto& [name, robot] : robots_) robot.under_way = false;
  std::erase_if(robots_, [](const auto& robot) { return !robot.second.news; });
}

void Carried::state_comes_back() {
  for (auto& [name, robot] : robots_) robot.news = std::exchange(robot.under_way, false) || robot.news;
}

/// As lanes::MarkerLane::put_back().
void Carried::markers_come_back() {
  lanes::MarkerChanges older;
  for (icd::Marker& marker : std::exchange(markers_under_way_, {})) older.apply(std::move(marker));
  markers_.apply_before(std::move(older));
}

icd::MarkersUpdate Carried::markers() const {
  Carried ended = *this;
  ended.markers_come_back();
  icd::MarkersUpdate update;
  update.markers.reserve(ended.markers_.size().count);
  for (const auto& [place, marker] : ended.markers_.in_order()) update.markers.push_back(marker);
  return update;
}

void Carried::write(const std::function<void(Kind, std::string_view)>& to) const {
  if (clock_) to(Kind::Clock, said(*clock_));
  for (const auto& [stamper, clock] : senders_.clocks()) to(Kind::Sender, said(stamper, clock));
  for (const auto& [uri, learned] : paces_) to(Kind::Pace, said(uri, learned));
  for (const auto& [uri, stamp] : stamps_) to(Kind::Stamp, said(uri, stamp));
  if (grids_) {
    to(Kind::Grids, {});
    for (const auto& [key, extent] : *grids_) to(Kind::Grids, said(key, extent));
  }
  for (const auto& [robot, heard] : heard_) to(Kind::Heard, said(heard));
  const auto write_robots = [&](bool Robot::* these) {
    std::vector<icd::RobotName> names;
    for (const auto& [name, robot] : robots_) {
      if (!(robot.*these)) continue;
      to(Kind::Poses, said(std::span(&robot.posted, 1)));
      names.push_back(name);
    }
    return names;
  };
  to(Kind::StateSent, said_sent(write_robots(&Robot::under_way)));
  write_robots(&Robot::news);
  const auto write_markers = [&to](const std::vector<icd::Marker>& markers) {
    for (std::size_t i = 0; i < markers.size(); i += kMarkersInARecord) {
      const auto first = markers.begin() + static_cast<std::ptrdiff_t>(i);
      const auto count = static_cast<std::ptrdiff_t>(std::min(markers.size() - i, kMarkersInARecord));
      to(Kind::Markers, said(icd::MarkersUpdate{.markers = {first, first + count}}));
    }
  };
  write_markers(markers_under_way_);
  to(Kind::MarkersSent, said_sent(markers_under_way_));
  std::vector<icd::Marker> waiting;
  for (const auto& [place, marker] : markers_.in_order()) waiting.push_back(marker);
  write_markers(waiting);
}

std::pair<Carried, std::string> read_records(const store::Contents& contents) {
  Carried carried;
  std::string damage;
  std::size_t unknown = 0;
  for (const store::Item& item : contents.items) {
    if (const auto* const gap = std::get_if<store::Gap>(&item)) {
      damage = "records of the journal are missing: " + gap->file;
      continue;
    }
    const auto& record = std::get<store::Record>(item);
    Kind kind{record.kind};
    if (!damage.empty() && kind == Kind::StateDone) kind = Kind::StateBack;
    if (!damage.empty() && kind == Kind::MarkersDone) kind = Kind::MarkersBack;
    if (!carried.apply(kind, record.body)) ++unknown;
  }
  if (unknown > 0) {
    host::log(host::Level::Error, "unknown journal records skipped", {{"records", std::to_string(unknown)}});
  }
  return {std::move(carried), std::move(damage)};
}

std::string said(const Clock& clock) {
  Writer out;
  out.text(clock.boot).number(number_of(clock.at.time_since_epoch())).real(clock.stamp);
  out.real(clock.leapt_to).real(clock.leapt_by);
  return out.real(clock.off).real(clock.off_since).finish();
}

std::string said(const lanes::Stamper& stamper, const lanes::SenderClock& clock) {
  return Writer()
      .text(stamper.address)
      .number(static_cast<std::uint64_t>(stamper.uri))
      .text(stamper.robot)
      .real(clock.theirs)
      .real(clock.ours)
      .real(clock.latest)
      .finish();
}

std::string said(icd::Uri uri, const pace::Learned& learned) {
  return Writer()
      .number(static_cast<std::uint64_t>(uri))
      .number(number_of(learned.earliest.first.time_since_epoch()))
      .number(number_of(learned.spacing))
      .number(learned.under_way ? 1 : 0)
      .number(number_of(learned.earliest.last.time_since_epoch()))
      .number(static_cast<std::uint64_t>(learned.single) * 2 + (learned.from_answers ? 1 : 0))
      .finish();
}

std::string said(icd::Uri uri, icd::Stamp stamp) {
  return Writer().number(static_cast<std::uint64_t>(uri)).real(stamp).finish();
}

std::string said(const std::string& name, const lanes::Extent& extent) {
  return Writer()
      .text(name)
      .real(extent.left)
      .real(extent.bottom)
      .real(extent.right)
      .real(extent.top)
      .finish();
}

std::string said(std::span<const lanes::PostedPose> poses) {
  Writer out;
  for (lanes::PostedPose posted : poses) {
    out.text(posted.name.text()).text(posted.address);
    out.real(posted.stamp.value_or(std::numeric_limits<double>::quiet_NaN()));
    for (const double* const part : parts_of(posted.pose)) out.real(*part);
  }
  return out.finish();
}

std::string said(const Heard& heard) {
  Writer out;
  out.text(heard.robot).number(heard.messages).real(heard.gap).real(heard.last);
  for (const auto& [accepted, forwarded] : heard.kinds) out.real(accepted).real(forwarded);
  return out.finish();
}

std::string said(const icd::MarkersUpdate& update) {
  return codec::write_markers_update(update).to_string();
}

std::string said_sent(const std::vector<icd::RobotName>& robots) {
  Writer out;
  out.number(robots.size());
  for (const icd::RobotName& robot : robots) out.text(robot.text());
  return out.finish();
}

std::string said_sent(const std::vector<icd::Marker>& markers) {
  Writer out;
  out.number(markers.size());
  for (const icd::Marker& marker : markers) {
    out.text(marker.ns)
        .number(static_cast<std::uint64_t>(std::int64_t{marker.id}))
        .number(static_cast<std::uint64_t>(marker.action));
  }
  return out.finish();
}

}  // namespace adit::journal
