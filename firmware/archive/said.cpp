#include "archive/said.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "codec/utf8.hpp"
#include "journal/record.hpp"

namespace adit::archive {
namespace {

using journal::Reader;
using journal::Writer;

constexpr std::uint64_t kFormat = 1;
/// What is later is no time.
constexpr double kLatest = 1e11;

std::uint64_t written_int(int number) {
  return static_cast<std::uint64_t>(std::int64_t{number});
}

/// An int that lies within the world; else `ok` is false.
int int_in(Reader& in, bool& ok) {
  constexpr std::int64_t kMost = 1 << 20;
  const auto number = static_cast<std::int64_t>(in.number());
  ok = ok && number >= -kMost && number <= kMost;
  return ok ? static_cast<int>(number) : 0;
}

double real_in(Reader& in, bool& ok) {
  const double number = in.real();
  ok = ok && std::isfinite(number);
  return number;
}

double time_in(Reader& in, bool& ok) {
  const double time = real_in(in, ok);
  ok = ok && time >= 0 && time < kLatest;
  return time;
}

std::string text_in(Reader& in, bool& ok) {
  const std::string_view text = in.text();
  codec::Utf8Checker utf8;
  ok = ok && text.size() <= kMostText && !utf8.feed(text) && utf8.complete();
  return std::string(ok ? text : std::string_view());
}

void put_text(Writer& out, std::string_view text) {
  std::size_t end = std::min(text.size(), kMostText);
  // Not within a character of UTF-8.
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  out.text(text.substr(0, end));
}

/// Not a number stands for nothing.
void put_optional(Writer& out, const std::optional<double>& number) {
  out.real(number.value_or(std::numeric_limits<double>::quiet_NaN()));
}
std::optional<double> optional_in(Reader& in) {
  const double number = in.real();
  return std::isfinite(number) ? std::optional(number) : std::nullopt;
}

void put_layer(Writer& out, const picture::Layer& layer) {
  put_text(out, layer.robot);
  out.number(static_cast<std::uint64_t>(layer.kind));
}

picture::Layer layer_in(Reader& in, bool& ok) {
  picture::Layer layer{.robot = text_in(in, ok)};
  const std::uint64_t kind = in.number();
  ok = ok && kind <= static_cast<std::uint64_t>(picture::Kind::Cloud);
  if (ok) layer.kind = static_cast<picture::Kind>(kind);
  return layer;
}

template <class T>
std::optional<T> whole(const Reader& in, bool ok, T value) {
  if (!ok || !in.ok() || !in.at_end()) return std::nullopt;
  return value;
}

}  // namespace

std::string said(const Head& head) {
  Writer out;
  out.number(kFormat).number(static_cast<std::uint64_t>(head.run)).real(head.began);
  put_text(out, head.post);
  out.number(picture::kSide).number(picture::kStep).number(picture::kLevels).real(picture::kPixel);
  return out.finish();
}

std::optional<HeadRead> read_head(std::string_view said) {
  Reader in(said);
  bool ok = in.number() == kFormat;
  HeadRead read;
  read.head.run = static_cast<std::int64_t>(in.number());
  read.head.began = time_in(in, ok);
  read.head.post = text_in(in, ok);
  const bool side = in.number() == picture::kSide, step = in.number() == picture::kStep,
             levels = in.number() == picture::kLevels, pixel = in.real() == picture::kPixel;
  read.tiles_fit = side && step && levels && pixel;
  return whole(in, ok, std::move(read));
}

std::string said(const TileState& state) {
  Writer out;
  put_layer(out, state.layer);
  out.number(written_int(state.at.level)).number(written_int(state.at.x)).number(written_int(state.at.y));
  out.real(state.stamp).number(state.tile ? state.tile->crc : 0);
  std::string_view bytes;
  if (state.tile)
    bytes = {reinterpret_cast<const char*>(state.tile->deflated.data()), state.tile->deflated.size()};
  return out.text(bytes).finish();
}

std::optional<TileState> read_tile(std::string_view said) {
  Reader in(said);
  bool ok = true;
  TileState state{.layer = layer_in(in, ok)};
  const int level = int_in(in, ok), x = int_in(in, ok), y = int_in(in, ok);
  state.at = {level, x, y};
  ok = ok && level >= 0 && level < picture::kLevels && std::abs(x) <= picture::kWorldTiles &&
       std::abs(y) <= picture::kWorldTiles;
  state.stamp = time_in(in, ok);
  const std::uint64_t crc = in.number();
  const std::string_view bytes = in.text();
  if (ok && !bytes.empty()) {
    const auto tile = std::make_shared<picture::Packed>();
    tile->deflated.assign(bytes.begin(), bytes.end());
    tile->crc = static_cast<std::uint32_t>(crc);
    state.tile = tile;
  }
  return whole(in, ok, std::move(state));
}

std::string said(const picture::LayerView& view) {
  Writer out;
  put_layer(out, view.layer);
  out.real(view.first).real(view.last).number(view.missed).number(view.left_out);
  const auto area = view.bounds.value_or(picture::Area{});
  out.number(view.bounds ? 1 : 0).real(area.left).real(area.bottom).real(area.right).real(area.top);
  const auto heights = view.heights.value_or(picture::Heights{});
  return out.number(view.heights ? 1 : 0).real(heights.low).real(heights.high).finish();
}

std::optional<picture::LayerView> read_layer(std::string_view said) {
  Reader in(said);
  bool ok = true;
  picture::LayerView view;
  view.layer = layer_in(in, ok);
  view.first = time_in(in, ok);
  view.last = time_in(in, ok);
  view.missed = in.number();
  view.left_out = in.number();
  const bool has_area = in.number() == 1;
  const double left = real_in(in, ok), bottom = real_in(in, ok), right = real_in(in, ok),
               top = real_in(in, ok);
  const double most = picture::kWorldMetres;
  ok = ok && -most <= left && left <= right && right <= most && -most <= bottom && bottom <= top &&
       top <= most;
  if (has_area) view.bounds = picture::Area{left, bottom, right, top};
  const bool has_heights = in.number() == 1;
  const double low = real_in(in, ok), high = real_in(in, ok);
  if (has_heights) view.heights = picture::Heights{low, high};
  return whole(in, ok, std::move(view));
}

std::string said_time(double stamp) {
  return Writer().real(stamp).finish();
}

std::optional<double> read_time(std::string_view said) {
  Reader in(said);
  bool ok = true;
  const double stamp = time_in(in, ok);
  return whole(in, ok, stamp);
}

std::string said(const Step& step) {
  return Writer().real(step.seconds).real(step.when).finish();
}

std::optional<Step> read_step(std::string_view said) {
  Reader in(said);
  bool ok = true;
  const Step step{.seconds = real_in(in, ok), .when = real_in(in, ok)};
  ok = ok && std::abs(step.seconds) < kLatest;
  return whole(in, ok, step);
}

std::string said(const std::string& robot, std::span<const api::TrackPose> poses) {
  Writer out;
  put_text(out, robot);
  out.number(poses.size());
  for (const api::TrackPose& pose : poses) {
    out.real(pose.at).real(pose.position.x).real(pose.position.y).real(pose.position.z).real(pose.heading);
  }
  return out.finish();
}

std::optional<api::Track> read_poses(std::string_view said) {
  Reader in(said);
  bool ok = true;
  api::Track track{.robot = text_in(in, ok), .poses = {}};
  const std::uint64_t count = in.number();
  ok = ok && count <= kLargestPoses;
  for (std::uint64_t i = 0; i < count && ok && in.ok(); ++i) {
    api::TrackPose& pose = track.poses.emplace_back();
    pose.at = time_in(in, ok);
    for (double* part : {&pose.position.x, &pose.position.y, &pose.position.z, &pose.heading})
      *part = real_in(in, ok);
  }
  return whole(in, ok, std::move(track));
}

std::string said(const Sample& sample) {
  Writer out;
  out.real(sample.at).real(sample.sent_mbit).number(sample.queued_bytes);
  put_optional(out, sample.scoring_ms);
  put_optional(out, sample.mapping_ms);
  out.number(sample.throttled);
  const std::size_t robots = std::min(sample.map_ages.size(), kMostRobots);
  out.number(robots);
  for (const auto& [robot, age] : std::span(sample.map_ages).first(robots)) {
    put_text(out, robot);
    out.real(age);
  }
  return out.finish();
}

std::optional<Sample> read_sample(std::string_view said) {
  Reader in(said);
  bool ok = true;
  Sample sample{.at = time_in(in, ok), .sent_mbit = real_in(in, ok), .queued_bytes = in.number()};
  sample.queued_bytes &= std::uint64_t{INT64_MAX};
  sample.scoring_ms = optional_in(in);
  sample.mapping_ms = optional_in(in);
  sample.throttled = in.number() & std::uint64_t{INT64_MAX};
  const std::uint64_t robots = in.number();
  ok = ok && robots <= kMostRobots;
  for (std::uint64_t i = 0; i < robots && ok && in.ok(); ++i) {
    std::string robot = text_in(in, ok);
    const double age = real_in(in, ok);
    sample.map_ages.emplace_back(std::move(robot), age);
  }
  return whole(in, ok, std::move(sample));
}

std::string said(const api::AttentionStep& step) {
  Writer out;
  out.real(step.at).number(step.came ? 1 : 0);
  put_text(out, step.sentence);
  return out.finish();
}

std::optional<api::AttentionStep> read_attention(std::string_view said) {
  Reader in(said);
  bool ok = true;
  api::AttentionStep step{.at = time_in(in, ok), .came = in.number() == 1, .sentence = text_in(in, ok)};
  return whole(in, ok, std::move(step));
}

}  // namespace adit::archive
