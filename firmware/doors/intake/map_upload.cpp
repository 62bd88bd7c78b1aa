#include "intake/map_upload.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "codec/read.hpp"
#include "icd/map_update.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/guard.hpp"

namespace adit::intake {
namespace {

using Pieces = std::deque<std::vector<std::uint8_t>>;

/// The worker's part. During a job only the worker uses it.
class Decoding {
 public:
  Decoding(codec::BodyKind kind, const icd::Rules& rules)
      : rules_(rules),
        most_at_once_(kind.coding == codec::ContentCoding::Identity ? std::numeric_limits<std::size_t>::max()
                                                                    : MapUpload::kStored / kGrowth),
        decoder_(kind, codec::Split::MapData, {.values = kSmallValues, .data_bytes = rules.map_bytes}) {}

  /// The data that was removed before the end.
  struct Before {
    std::shared_ptr<MapArrival> stored;  // null: no data was stored
    icd::ChunkedBytes left;              // data after the stored data
  };

  /// Decodes about kStored bytes of data. has_more(): received bytes are left. `before`: set if the body is
  /// whole.
  void work(Pieces& pieces, std::optional<Before> before) {
    for (auto& piece : pieces) pieces_.push_back(std::move(piece));
    pieces.clear();
    const std::size_t enough = decoder_.data_held() + MapUpload::kStored;
    const std::size_t long_enough = decoder_.size() + kMostOfBody;
    while (has_more() && decoder_.data_held() < enough && decoder_.size() < long_enough) {
      if (auto fed = feed_some(); !fed) {
        result_ = std::unexpected(std::move(fed.error()));
        return;
      }
    }
    if (before && !has_more()) result_ = finish(std::move(*before));
  }

  bool has_more() const { return !pieces_.empty(); }
  std::size_t data_held() const { return decoder_.data_held(); }
  icd::ChunkedBytes take_data() { return decoder_.take_data(); }

  /// nullopt while more of the body is to come.
  std::optional<icd::Checked<icd::MapUpdate>>& result() { return result_; }

 private:
  icd::Checked<icd::MapUpdate> finish(Before before) {
    auto document = ADIT_TRY(decoder_.finish());
    if (before.stored) {
      auto data = ADIT_TRY(before.stored->stored());
      data.append(before.left);
      data.append(document.data);
      document.data = std::move(data);
    }
    return codec::read_map_update(std::move(document), rules_);
  }

  icd::Checked<void> feed_some() {
    const auto left = std::span(pieces_.front()).subspan(fed_);
    const auto some = left.first(std::min(left.size(), most_at_once_));
    auto fed = decoder_.feed(some);
    fed_ += some.size();
    if (some.size() == left.size()) {
      pieces_.pop_front();
      fed_ = 0;
    }
    return fed;
  }

  static constexpr std::size_t kGrowth =
      1032;  // the most bytes that deflate makes of one byte (RFC 1951 3.2.5: 258 by 2 bits)

  /// The most inflated bytes of a body in one job, because gzipped cells may never reach kStored.
  static constexpr std::size_t kMostOfBody = 8 * MapUpload::kStored;

  icd::Rules rules_;
  std::size_t most_at_once_;
  codec::BodyDecoder decoder_;
  Pieces pieces_;        // of the body, in order
  std::size_t fed_ = 0;  // bytes of the first piece
  std::optional<icd::Checked<icd::MapUpdate>> result_;
};

}  // namespace

class MapUpload::State final : public Taking, public std::enable_shared_from_this<State> {
 public:
  State(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
        std::shared_ptr<UploadBudget> budget)
      : Taking(std::move(visit), std::move(budget)),
        options_(std::move(options)),
        without_room_(options_.without_room, visit_.sender.address),
        flow_(std::move(flow)),
        workers_(workers),
        arrival_(visit_.desk.map_arrives()),
        decoding_(std::make_shared<Decoding>(options_.kind, options_.rules)) {}

  bool take(std::span<const std::uint8_t> piece) override;
  void whole() override {
    whole_ = true;
    give_to_worker();
  }

 private:
  void let_go() override {
    pending_.clear();
    left_ = {};
    decoding_.reset();
    arrival_.reset();
  }
  bool charge();
  bool is_held();
  bool is_worth_it() const;
  void give_to_worker();
  void worked();
  void take_result(icd::Checked<icd::MapUpdate> result);
  void store_what_came();
  void stored(icd::ChunkedBytes left);
  void go_on();
  static icd::Refusal not_held() {
    return {icd::Status::ServiceUnavailable, "Adit has no memory for this map; send it again later"};
  }
  void failed() {
    at_work_ = false;
    turn_away(not_held());
  }

  MapUploadOptions options_;
  UploadShare without_room_;
  std::shared_ptr<Flow> flow_;
  loop::Workers& workers_;
  std::shared_ptr<MapArrival> arrival_;  // null if over; so is the next
  std::shared_ptr<Decoding> decoding_;
  Pieces pending_;
  std::size_t pending_bytes_ = 0;
  std::size_t data_ = 0;  // decoded bytes of the map's data, and the part taken from decoding_
  std::size_t taken_ = 0;
  bool at_work_ = false;  // a worker runs, and only it uses decoding_
  bool storing_ = false;
  bool has_stored_ = false;
  icd::ChunkedBytes left_;  // there was no room to store it
  bool held_back_ = false;
  bool whole_ = false;
};

bool MapUpload::State::take(std::span<const std::uint8_t> piece) {
  if (over_) return true;
  visit_.sender.bytes += piece.size();
  if (visit_.sender.bytes > options_.most_bytes) {
    turn_away({icd::Status::ContentTooLarge,
               icd::sentence("body: expected at most ", options_.most_bytes, " bytes")});
    return true;
  }
  if (!charge()) return true;
  pending_.emplace_back(piece.begin(), piece.end());
  pending_bytes_ += piece.size();
  give_to_worker();
  held_back_ = pending_bytes_ > kPending;
  return !held_back_;
}

/// Charges the budget for the body, or for its decoded data if that is larger. False: the map is rejected.
bool MapUpload::State::charge() {
  if (share_.grow_to(std::max(visit_.sender.bytes, data_))) return true;
  turn_away({icd::Status::TooManyRequests, "too many maps at once; send this map again later"});
  return false;
}

/// Charges the budget for data that cannot be stored. Not while the worker runs. False: the map is rejected.
bool MapUpload::State::is_held() {
  const std::size_t holds = left_.empty() ? 0 : left_.size() + decoding_->data_held();
  if (without_room_.grow_to(holds)) return true;
  turn_away({icd::Status::ServiceUnavailable, "the queue of maps is full; send this map again later"});
  return false;
}

/// Not while the worker runs. The beginning is decoded at once, because it may be rejected. After that the
/// worker does not start for a few bytes.
bool MapUpload::State::is_worth_it() const {
  if (whole_ || decoding_->has_more()) return true;
  const bool is_first = pending_bytes_ == visit_.sender.bytes;
  return !pending_.empty() && (is_first || pending_bytes_ >= kTogether);
}

void MapUpload::State::give_to_worker() {
  if (at_work_ || over_ || !is_worth_it()) return;
  if (storing_ && (whole_ || decoding_->data_held() >= kStored)) return;  // stored() continues
  at_work_ = true;
  auto pieces = std::make_shared<Pieces>();
  if (!decoding_->has_more()) {
    pieces->swap(pending_);
    pending_bytes_ = 0;
  }
  std::optional<Decoding::Before> before;
  if (whole_ && pending_.empty()) before.emplace(has_stored_ ? arrival_ : nullptr, left_);
  // `done` also holds the arrival, so that the loop is the last to release it.
  workers_.submit(
      loop::Urgency::OnTheWay,
      [decoding = decoding_, pieces, before = std::move(before)] { decoding->work(*pieces, before); },
      [self = shared_from_this(), arrival = arrival_] { self->worked(); },
      [self = shared_from_this()] { self->failed(); });
}

void MapUpload::State::worked() {
  at_work_ = false;
  if (over_) return;
  const bool well = loop::guarded("receiving a map", [this] {
    if (auto& result = decoding_->result()) return take_result(std::move(*result));
    go_on();
  });
  if (!well) fail(not_held());
}

void MapUpload::State::take_result(icd::Checked<icd::MapUpdate> result) {
  const auto arrival = arrival_;
  abandon();
  if (!result) return visit_.answer(std::unexpected(std::move(result.error())));
  arrival->take(std::move(*result), visit_.sender_at_end(),
                [self = shared_from_this()](const icd::Checked<void>& taken) { self->visit_.answer(taken); });
}

/// Not while the worker runs.
void MapUpload::State::go_on() {
  data_ = taken_ + decoding_->data_held();
  if (!charge() || !is_held()) return;
  store_what_came();
  give_to_worker();
  if (pending_bytes_ <= kPending && std::exchange(held_back_, false)) flow_->resume();
}

/// If there was no room once, the rest is held in memory until the end, when the map is checked.
void MapUpload::State::store_what_came() {
  if (storing_ || !left_.empty() || decoding_->data_held() < kStored) return;
  has_stored_ = storing_ = true;
  taken_ += decoding_->data_held();
  arrival_->store(decoding_->take_data(),
                  [self = shared_from_this()](icd::ChunkedBytes left) { self->stored(std::move(left)); });
}

void MapUpload::State::stored(icd::ChunkedBytes left) {
  storing_ = false;
  if (over_) return;
  left_ = std::move(left);
  if (at_work_) return;
  if (!loop::guarded("storing a map", [this] { go_on(); })) failed();
}

MapUpload::MapUpload(const Visit& visit, MapUploadOptions options, std::shared_ptr<Flow> flow,
                     loop::Workers& workers, std::shared_ptr<UploadBudget> budget)
    : WorkerUpload(visit,
                   std::make_shared<State>(visit, options, std::move(flow), workers, std::move(budget))) {}

}  // namespace adit::intake
