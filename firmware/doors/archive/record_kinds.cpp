#include "archive/record_kinds.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "codec/utf8.hpp"
#include "icd/require.hpp"
#include "icd/text.hpp"
#include "store/frame.hpp"

namespace adit::archive {
namespace {

/// A frame may begin anywhere, and is valid at any place of any file.
constexpr store::Layout kPacked{.align = 1, .copies = 1};
constexpr std::uint64_t kSalt = 0;
constexpr std::size_t kPlace = 0;
/// Limits the checksums spent on bytes that only look like a record.
constexpr int kMostDamaged = 4096;

std::size_t size_of(std::string_view bytes) {
  return store::room_of(store::number_at(bytes, 8, 4), kPacked);
}

/// The body of the first record in `bytes`; empty if damaged.
std::string_view body_at_begin(std::string_view bytes) {
  if (size_of(bytes) > store::room_of(kLargestRecord, kPacked)) return {};
  const auto parsed = store::parse(bytes, kPlace, kSalt);
  return parsed ? parsed->frame.body : std::string_view();
}

/// Whether the first record has its full length. A torn record is shorter.
bool is_whole(std::string_view bytes) {
  const std::size_t size = size_of(bytes), head = store::room_of(0, kPacked);
  return size == bytes.size() ||
         (size < bytes.size() && store::next_candidate(bytes.substr(size, head), 0, kPacked) == 0);
}

}  // namespace

std::string frame_record(std::string_view body) {
  icd::require(!body.empty() && body.size() <= kLargestRecord);
  return store::to_bytes({.body = body}, kPacked, kSalt, kPlace);
}

std::size_t for_each_record(std::string_view bytes, const std::function<void(std::string_view)>& told) {
  std::size_t damaged = 0;
  for (int passed_over = 0; passed_over < kMostDamaged;) {
    bytes.remove_prefix(store::next_candidate(bytes, 0, kPacked));
    if (bytes.empty()) break;
    const std::string_view body = body_at_begin(bytes);
    if (body.empty()) {
      ++passed_over;
      if (is_whole(bytes)) ++damaged;
      bytes.remove_prefix(1);
      continue;
    }
    told(body);
    bytes.remove_prefix(size_of(bytes));
  }
  return damaged;
}

void Lines::add(std::string record, bool is_news) {
  bytes_ += record.size();
  records_.push_back(std::move(record));
  is_due_ = is_due_ || is_news;
  trim_to(kMost);
}

std::string Lines::pop(loop::Instant now) {
  std::string taken;
  while (!records_.empty() && taken.size() + records_.front().size() <= kLargestRecord) {
    taken += records_.front();
    records_.pop_front();
  }
  bytes_ -= taken.size();
  is_due_ = !records_.empty();
  rests_until_ = now + kRest;
  return taken;
}

void Lines::give_back(std::string records) {
  if (records.empty()) return;
  bytes_ += records.size();
  records_.push_front(std::move(records));
  is_due_ = true;
}

void Lines::trim_to(std::size_t most) {
  while (bytes_ > most) {
    bytes_ -= records_.front().size();
    records_.pop_front();
  }
}

}  // namespace adit::archive

namespace adit {

template <>
inline constexpr auto store::kMembers<archive::Head> =
    std::tuple(&archive::Head::run, &archive::Head::began, &archive::Head::post, &archive::Head::side,
               &archive::Head::step, &archive::Head::levels, &archive::Head::pixel);
template <>
inline constexpr auto store::kMembers<archive::TileState> =
    std::tuple(&archive::TileState::layer, &archive::TileState::at, &archive::TileState::stamp,
               &archive::TileState::tile);
template <>
inline constexpr auto store::kMembers<archive::WipeRecord> = std::tuple(&archive::WipeRecord::stamp);
template <>
inline constexpr auto store::kMembers<archive::Sample> =
    std::tuple(&archive::Sample::at, &archive::Sample::sent_mbit, &archive::Sample::queued_bytes,
               &archive::Sample::scoring_ms, &archive::Sample::mapping_ms, &archive::Sample::throttled,
               &archive::Sample::map_ages);
template <>
inline constexpr auto store::kMembers<archive::Step> =
    std::tuple(&archive::Step::seconds, &archive::Step::when);
template <>
inline constexpr auto store::kMembers<picture::Layer> =
    std::tuple(&picture::Layer::robot, &picture::Layer::kind);
template <>
inline constexpr auto store::kMembers<picture::TileIndex> =
    std::tuple(&picture::TileIndex::level, &picture::TileIndex::x, &picture::TileIndex::y);
template <>
inline constexpr auto store::kMembers<picture::LayerView> =
    std::tuple(&picture::LayerView::layer, &picture::LayerView::first, &picture::LayerView::last,
               &picture::LayerView::missed, &picture::LayerView::left_out, &picture::LayerView::bounds,
               &picture::LayerView::heights);
/// The mosaic has its version, its tiles and its finer picture.
template <>
inline constexpr std::size_t store::kMemberCount<picture::LayerView> = 7;
template <>
inline constexpr auto store::kMembers<picture::Area> =
    std::tuple(&picture::Area::left, &picture::Area::bottom, &picture::Area::right, &picture::Area::top);
template <>
inline constexpr auto store::kMembers<picture::Heights> =
    std::tuple(&picture::Heights::low, &picture::Heights::high);
template <>
inline constexpr auto store::kMembers<api::Track> = std::tuple(&api::Track::robot, &api::Track::poses);
template <>
inline constexpr auto store::kMembers<api::TrackPose> =
    std::tuple(&api::TrackPose::at, &api::TrackPose::position, &api::TrackPose::heading);
template <>
inline constexpr auto store::kMembers<icd::Point> =
    std::tuple(&icd::Point::x, &icd::Point::y, &icd::Point::z);
template <>
inline constexpr auto store::kMembers<api::AttentionStep> =
    std::tuple(&api::AttentionStep::at, &api::AttentionStep::came, &api::AttentionStep::sentence);

namespace archive {
namespace {

class RecordWriter : public store::Writer {
 public:
  using store::Writer::operator();
  /// Truncates a text between two UTF-8 characters.
  void operator()(const std::string& text) { (*this)(icd::beginning_of(text, kMostText)); }
  void operator()(const picture::Tile& tile) {
    (*this)(tile ? tile->crc : 0);
    (*this)(
        tile ? std::string_view(reinterpret_cast<const char*>(tile->deflated.data()), tile->deflated.size())
             : std::string_view());
  }
};

/// Accepts finite numbers and short UTF-8 texts.
class RecordReader : public store::Reader {
 public:
  using store::Reader::Reader, store::Reader::operator();
  void operator()(double& real) {
    store::Reader::operator()(real);
    check(std::isfinite(real));
  }
  void operator()(std::string& text) {
    store::Reader::operator()(text);
    check(text.size() <= kMostText && codec::is_utf8(text));
  }
  void operator()(picture::Tile& tile) {
    const auto packed = std::make_shared<picture::PackedTile>();
    packed->crc = read<std::uint32_t>();
    const auto bytes = read<std::string_view>();
    packed->deflated.assign(bytes.begin(), bytes.end());
    if (!bytes.empty()) tile = packed;
  }
};

/// Largest valid time.
constexpr double kLatest = 1e11;
bool is_time(double time) {
  return time >= 0 && time < kLatest;
}

bool is_between(double from, double to, double most) {
  return -most <= from && from <= to && to <= most;
}

/// Whether values are within their limits.
bool is_good(const picture::Layer& layer) {
  return layer.kind <= picture::LayerKind::Cloud;
}
bool is_good(const Head& head) {
  return is_time(head.began);
}
bool is_good(const TileState& state) {
  const auto& [level, x, y] = state.at;
  constexpr int kMost = picture::kWorldTiles;
  return is_good(state.layer) && level >= 0 && level < picture::kLevels && is_between(x, x, kMost) &&
         is_between(y, y, kMost) && is_time(state.stamp);
}
bool is_good(const picture::LayerView& view) {
  const picture::Area area = view.bounds.value_or(picture::Area());
  constexpr double kMost = picture::kWorldMetres;
  return is_good(view.layer) && is_time(view.first) && is_time(view.last) &&
         is_between(area.left, area.right, kMost) && is_between(area.bottom, area.top, kMost);
}
bool is_good(const WipeRecord& wiped) {
  return is_time(wiped.stamp);
}
bool is_good(const api::Track& track) {
  return std::ranges::all_of(track.poses, is_time, &api::TrackPose::at);
}
bool is_good(const Sample& sample) {
  return is_time(sample.at) && std::max(sample.queued_bytes, sample.throttled) <= INT64_MAX;
}
bool is_good(const api::AttentionStep& step) {
  return is_time(step.at);
}
bool is_good(const Step& step) {
  return std::abs(step.seconds) < kLatest;
}

template <class Of>
std::optional<Record> read_one(std::string_view values) {
  Of one{};
  if (!store::read<RecordReader>(values, one) || !is_good(one)) return std::nullopt;
  return one;
}

template <class... Of>
std::optional<Record> read_any(std::size_t kind, std::string_view values, const std::variant<Of...>& /*of*/) {
  constexpr std::optional<Record> (*kReaders[])(std::string_view) = {read_one<Of>...};
  return kind < sizeof...(Of) ? kReaders[kind](values) : std::nullopt;
}

}  // namespace

std::string record_of(const Record& record) {
  const std::string kind(1, static_cast<char>(record.index()));
  return frame_record(kind +
                      std::visit([](const auto& one) { return store::bytes_of<RecordWriter>(one); }, record));
}

std::optional<Record> read(std::string_view body) {
  return read_any(static_cast<unsigned char>(body.at(0)), body.substr(1), Record());
}

}  // namespace archive
}  // namespace adit
