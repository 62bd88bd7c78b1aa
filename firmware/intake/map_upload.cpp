#include "intake/map_upload.hpp"

#include <optional>
#include <string>
#include <utility>

#include "codec/read.hpp"
#include "icd/map_update.hpp"
#include "icd/sentence.hpp"
#include "loop/guard.hpp"

namespace adit::intake {
namespace {

using Pieces = std::vector<std::vector<std::uint8_t>>;

/// The worker's part: touched by nobody else while a piece of work is under way.
class Decoding {
 public:
  Decoding(codec::BodyKind kind, const icd::Rules& rules)
      : rules_(rules),
        decoder_(kind, codec::Split::MapData, {.values = kSmallValues, .data_bytes = rules.map_bytes}) {}

  /// What was taken out of it before the end.
  struct Before {
    std::shared_ptr<MapArrival> stored;  // null: nothing
    icd::ChunkedBytes left;              // follows what was stored
  };

  /// `before`: where the body is whole.
  void work(Pieces& pieces, std::optional<Before> before) {
    for (auto& piece : pieces) {
      if (auto fed = decoder_.feed(piece); !fed) {
        result_ = std::unexpected(std::move(fed.error()));
        return;
      }
      std::vector<std::uint8_t>().swap(piece);
    }
    if (before) result_ = finish(std::move(*before));
  }

  std::size_t data_held() const { return decoder_.data_held(); }
  icd::ChunkedBytes take_data() { return decoder_.take_data(); }

  /// Nothing while more of the body is to come.
  std::optional<icd::Checked<icd::MapUpdate>>& result() { return result_; }

 private:
  icd::Checked<icd::MapUpdate> finish(Before before) {
    auto document = decoder_.finish();
    if (!document) return std::unexpected(std::move(document.error()));
    if (before.stored) {
      auto data = before.stored->stored();
      if (!data) return std::unexpected(std::move(data.error()));
      data->append(before.left);
      data->append(document->data);
      document->data = std::move(*data);
    }
    return codec::read_map_update(std::move(*document), rules_);
  }

  icd::Rules rules_;
  codec::BodyDecoder decoder_;
  std::optional<icd::Checked<icd::MapUpdate>> result_;
};

}  // namespace

class MapUpload::State final : public Taking, public std::enable_shared_from_this<State> {
 public:
  State(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
        std::shared_ptr<UploadBudget> budget)
      : Taking(std::move(visit), std::move(budget)),
        options_(options),
        flow_(std::move(flow)),
        workers_(workers),
        arrival_(visit_.desk.map_arrives()),
        decoding_(std::make_shared<Decoding>(options.kind, options.rules)) {}

  bool take(std::span<const std::uint8_t> piece) override;
  void whole() override {
    whole_ = true;
    give_to_worker();
  }

 private:
  void let_go() override {
    pending_.clear();
    arrival_.reset();
  }
  void give_to_worker();
  void worked();
  void take_result(icd::Checked<icd::MapUpdate> result);
  void store_what_came();
  void stored(icd::ChunkedBytes left);
  void go_on();
  static icd::Refusal not_held() {
    return {icd::Status::ServiceUnavailable, "the gateway could not hold this map; send it again later"};
  }
  void failed() {
    at_work_ = false;
    turn_away(not_held());
  }

  MapUploadOptions options_;
  std::shared_ptr<Flow> flow_;
  loop::Workers& workers_;
  std::shared_ptr<MapArrival> arrival_;  // null once over
  std::shared_ptr<Decoding> decoding_;
  Pieces pending_;
  std::size_t pending_bytes_ = 0;
  bool at_work_ = false;  // a worker is, and decoding_ is its own
  bool storing_ = false;
  bool has_stored_ = false;
  icd::ChunkedBytes left_;  // there was no room for it
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
  if (!share_.take(piece.size())) {
    turn_away(
        {icd::Status::TooManyRequests, "too many maps are being sent at once; send this one again later"});
    return true;
  }
  pending_.emplace_back(piece.begin(), piece.end());
  pending_bytes_ += piece.size();
  if (options_.kind.coding != codec::ContentCoding::Identity) return true;
  give_to_worker();
  held_back_ = pending_bytes_ > kPending;
  return !held_back_;
}

void MapUpload::State::give_to_worker() {
  if (at_work_ || over_ || (pending_.empty() && !whole_)) return;
  if (storing_ && (whole_ || decoding_->data_held() >= kStored)) return;  // stored() goes on
  at_work_ = true;
  auto pieces = std::make_shared<Pieces>(std::exchange(pending_, {}));
  pending_bytes_ = 0;
  std::optional<Decoding::Before> before;
  if (whole_) before.emplace(has_stored_ ? arrival_ : nullptr, left_);
  // What comes after holds the arrival, too, so that the loop is the last to do so.
  workers_.submit(
      [decoding = decoding_, pieces, before = std::move(before)] { decoding->work(*pieces, before); },
      [self = shared_from_this(), arrival = arrival_] { self->worked(); },
      [self = shared_from_this()] { self->failed(); });
}

void MapUpload::State::worked() {
  at_work_ = false;
  if (over_) return;
  const bool well = loop::guarded("taking a map", [this] {
    if (auto& result = decoding_->result()) return take_result(std::move(*result));
    go_on();
  });
  if (!well) fail(not_held());
}

void MapUpload::State::take_result(icd::Checked<icd::MapUpdate> result) {
  const auto arrival = arrival_;
  abandon();
  if (!result) return visit_.answer(std::unexpected(std::move(result.error())));
  arrival->take(std::move(*result), visit_.sender,
                [self = shared_from_this()](const icd::Checked<void>& taken) { self->visit_.answer(taken); });
}

/// The worker is not at it.
void MapUpload::State::go_on() {
  store_what_came();
  give_to_worker();
  if (pending_bytes_ <= kPending && std::exchange(held_back_, false)) flow_->resume();
}

/// Where there was no room, there is none for the rest: it is held until the end, which judges it.
void MapUpload::State::store_what_came() {
  if (storing_ || !left_.empty() || decoding_->data_held() < kStored) return;
  if (options_.kind.coding != codec::ContentCoding::Identity) return;
  has_stored_ = storing_ = true;
  arrival_->store(decoding_->take_data(),
                  [self = shared_from_this()](icd::ChunkedBytes left) { self->stored(std::move(left)); });
}

void MapUpload::State::stored(icd::ChunkedBytes left) {
  storing_ = false;
  left_ = std::move(left);
  if (over_ || at_work_) return;
  if (!loop::guarded("storing a map", [this] { go_on(); })) failed();
}

MapUpload::MapUpload(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow,
                     loop::Workers& workers, std::shared_ptr<UploadBudget> budget,
                     std::shared_ptr<UnderWay> under_way)
    : WorkerUpload(
          std::make_shared<State>(std::move(visit), options, std::move(flow), workers, std::move(budget)),
          std::move(under_way)) {}

}  // namespace adit::intake
