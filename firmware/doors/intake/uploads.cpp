#include "intake/uploads.hpp"

#include <algorithm>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "codec/read.hpp"
#include "icd/mapping.hpp"
#include "icd/require.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "intake/answer.hpp"
#include "loop/guard.hpp"

namespace adit::intake {

Sender UploadContext::sender_at_end() const {
  Sender whole = sender;
  whole.ended = ++uploads->last;
  for (const Upload* other : uploads->under_way) {
    const bool is_other = other->is_same_source(*this) && other->began() != sender.began;
    if (is_other && (whole.overlaps == 0 || other->began() < whole.overlaps)) whole.overlaps = other->began();
  }
  return whole;
}

void UploadContext::refuse(const icd::Refusal& refusal, std::vector<Header> headers) const {
  Answer answer = error_answer(refusal.status, refusal.sentence);
  answer.headers = std::move(headers);
  responder->answer(std::move(answer));
  message_handler.on_rejected(uri, sender, refusal);
}

void UploadContext::answer(const icd::Checked<void>& taken) const {
  if (!taken) {
    refuse(taken.error());
  } else {
    responder->answer({.body = "null", .headers = {}});
  }
}

bool SmallUpload::on_body(std::span<const std::uint8_t> piece) {
  context_.sender.bytes += piece.size();
  const auto fed = decoder_.feed(piece);
  if (!fed) {
    context_.refuse(fed.error());
  } else if (!share_.grow_to(std::max(context_.sender.bytes, decoder_.size()))) {
    context_.refuse({icd::Status::ServiceUnavailable,
                     "too many bytes at once, from this address or in total; send this message again later"});
  }
  return true;
}

void SmallUpload::on_end() {
  whole_ = true;
  const auto document = decoder_.finish();
  if (!document) {
    context_.refuse(document.error());
  } else {
    give_to_handler(*document);
  }
}

void SmallUpload::give_to_handler(const codec::Document& document) {
  switch (context_.uri) {
    case icd::Uri::StateUpdate:
      return accept_state(document);
    case icd::Uri::ArtifactReports:
      return accept_report(document);
    case icd::Uri::Status:
    case icd::Uri::MapUpdate:
    case icd::Uri::MarkersUpdate:
      icd::require(false);
  }
}

void SmallUpload::accept_state(const codec::Document& document) {
  auto read = codec::read_state_parts(document, rules_);
  if (!read) return context_.refuse(read.error());
  auto taken = context_.message_handler.accept(std::move(read->message), context_.sender_at_end());
  if (taken && read->refused.count > 0) taken = std::unexpected(read->refused.refusal());
  context_.answer(taken);
}

void SmallUpload::accept_report(const codec::Document& document) {
  const auto read = codec::read_artifact_report(document, rules_);
  if (!read) return context_.refuse(read.error());
  if (!read->left_out.empty())
    context_.message_handler.record_dropped(context_.uri, context_.sender, read->left_out);
  context_.message_handler.accept(read->report, context_.sender, context_.responder);
}

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
  struct EarlierData {
    std::shared_ptr<MapArrival> stored;  // null: no data was stored
    icd::ChunkedBytes left;              // data after the stored data
  };

  /// Decodes about kStored bytes of data. has_more(): received bytes are left. `before`: set if the body is
  /// whole.
  void work(Pieces& pieces, std::optional<EarlierData> before) {
    for (auto& piece : pieces) pieces_.push_back(std::move(piece));
    pieces.clear();
    const std::size_t enough = decoder_.held_bytes() + MapUpload::kStored;
    const std::size_t long_enough = decoder_.size() + kMostOfBody;
    while (has_more() && decoder_.held_bytes() < enough && decoder_.size() < long_enough) {
      if (auto fed = feed_some(); !fed) {
        result_ = std::unexpected(std::move(fed.error()));
        return;
      }
    }
    if (before && !has_more()) result_ = finish(std::move(*before));
  }

  bool has_more() const { return !pieces_.empty(); }
  std::size_t held_bytes() const { return decoder_.held_bytes(); }
  icd::ChunkedBytes take_data() { return decoder_.take_data(); }

  /// nullopt while more of the body is to come.
  std::optional<icd::Checked<icd::MapUpdate>>& result() { return result_; }

 private:
  icd::Checked<icd::MapUpdate> finish(EarlierData before) {
    auto document = ADIT_TRY(decoder_.finish());
    if (before.stored) {
      auto data = ADIT_TRY(before.stored->stored_bytes());
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

  /// The most bytes that deflate makes of one byte (RFC 1951 3.2.5: 258 by 2 bits).
  static constexpr std::size_t kGrowth = 1032;

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

class MapUpload::State final : public LoopPart, public std::enable_shared_from_this<State> {
 public:
  State(UploadContext context, MapUploadOptions options, std::shared_ptr<FlowControl> flow,
        loop::Workers& workers, std::shared_ptr<UploadBudget> budget)
      : LoopPart(std::move(context), std::move(budget)),
        options_(std::move(options)),
        without_room_(options_.without_room, context_.sender.address),
        flow_(std::move(flow)),
        workers_(workers),
        arrival_(context_.message_handler.begin_map()),
        decoding_(std::make_shared<Decoding>(options_.kind, options_.rules)) {}

  bool consume(std::span<const std::uint8_t> piece) override;
  void on_whole() override {
    whole_ = true;
    give_to_worker();
  }

 private:
  void release_body() override {
    pending_.clear();
    left_ = {};
    decoding_.reset();
    arrival_.reset();
  }
  bool charge();
  bool is_held();
  bool has_enough_work() const;
  void give_to_worker();
  void on_worked();
  void on_result(icd::Checked<icd::MapUpdate> result);
  void store_received();
  void on_stored(icd::ChunkedBytes left);
  void process();
  static icd::Refusal no_memory_refusal() {
    return {icd::Status::ServiceUnavailable, "Adit has no memory for this map; send it again later"};
  }
  void on_failed() {
    at_work_ = false;
    reject(no_memory_refusal());
  }

  MapUploadOptions options_;
  UploadShare without_room_;
  std::shared_ptr<FlowControl> flow_;
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

bool MapUpload::State::consume(std::span<const std::uint8_t> piece) {
  if (over_) return true;
  context_.sender.bytes += piece.size();
  if (context_.sender.bytes > options_.most_bytes) {
    reject({icd::Status::ContentTooLarge,
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
  if (share_.grow_to(std::max(context_.sender.bytes, data_))) return true;
  reject({icd::Status::TooManyRequests, "too many maps at once; send this map again later"});
  return false;
}

/// Charges the budget for data that cannot be stored. Not while the worker runs. False: the map is rejected.
bool MapUpload::State::is_held() {
  const std::size_t holds = left_.empty() ? 0 : left_.size() + decoding_->held_bytes();
  if (without_room_.grow_to(holds)) return true;
  reject({icd::Status::ServiceUnavailable, "the queue of maps is full; send this map again later"});
  return false;
}

/// Not while the worker runs. The beginning is decoded at once, because it may be rejected. After that the
/// worker does not start for a few bytes.
bool MapUpload::State::has_enough_work() const {
  if (whole_ || decoding_->has_more()) return true;
  const bool is_first = pending_bytes_ == context_.sender.bytes;
  return !pending_.empty() && (is_first || pending_bytes_ >= kTogether);
}

void MapUpload::State::give_to_worker() {
  if (at_work_ || over_ || !has_enough_work()) return;
  if (storing_ && (whole_ || decoding_->held_bytes() >= kStored)) return;  // on_stored() continues
  at_work_ = true;
  auto pieces = std::make_shared<Pieces>();
  if (!decoding_->has_more()) {
    pieces->swap(pending_);
    pending_bytes_ = 0;
  }
  std::optional<Decoding::EarlierData> before;
  if (whole_ && pending_.empty()) before.emplace(has_stored_ ? arrival_ : nullptr, left_);
  // `done` also holds the arrival, so that the loop is the last to release it.
  workers_.submit(
      loop::Urgency::OnTheWay,
      [decoding = decoding_, pieces, before = std::move(before)] { decoding->work(*pieces, before); },
      [self = shared_from_this(), arrival = arrival_] { self->on_worked(); },
      [self = shared_from_this()] { self->on_failed(); });
}

void MapUpload::State::on_worked() {
  at_work_ = false;
  if (over_) return;
  const bool well = loop::run_guarded("receiving a map", [this] {
    if (auto& result = decoding_->result()) return on_result(std::move(*result));
    process();
  });
  if (!well) fail(no_memory_refusal());
}

void MapUpload::State::on_result(icd::Checked<icd::MapUpdate> result) {
  const auto arrival = arrival_;
  abandon();
  if (!result) return context_.answer(std::unexpected(std::move(result.error())));
  arrival->accept(
      std::move(*result), context_.sender_at_end(),
      [self = shared_from_this()](const icd::Checked<void>& taken) { self->context_.answer(taken); });
}

/// Not while the worker runs.
void MapUpload::State::process() {
  data_ = taken_ + decoding_->held_bytes();
  if (!charge() || !is_held()) return;
  store_received();
  give_to_worker();
  if (pending_bytes_ <= kPending && std::exchange(held_back_, false)) flow_->resume();
}

/// If there was no room once, the rest is held in memory until the end, when the map is checked.
void MapUpload::State::store_received() {
  if (storing_ || !left_.empty() || decoding_->held_bytes() < kStored) return;
  has_stored_ = storing_ = true;
  taken_ += decoding_->held_bytes();
  arrival_->store(decoding_->take_data(),
                  [self = shared_from_this()](icd::ChunkedBytes left) { self->on_stored(std::move(left)); });
}

void MapUpload::State::on_stored(icd::ChunkedBytes left) {
  storing_ = false;
  if (over_) return;
  left_ = std::move(left);
  if (at_work_) return;
  if (!loop::run_guarded("storing a map", [this] { process(); })) on_failed();
}

MapUpload::MapUpload(const UploadContext& context, MapUploadOptions options,
                     std::shared_ptr<FlowControl> flow, loop::Workers& workers,
                     std::shared_ptr<UploadBudget> budget)
    : WorkerUpload(context,
                   std::make_shared<State>(context, options, std::move(flow), workers, std::move(budget))) {}

namespace {

using Body = std::vector<std::uint8_t>;
using Parts = icd::Checked<codec::CheckedParts<icd::MarkersUpdate>>;

/// The loop decodes updates up to kAtOnce itself, in less than a millisecond.
constexpr codec::Limits kAtOnce = {.text_bytes = 32u << 10, .values = kSmallValues},
                        kSmall = {.values = kSmallValues},
                        kLarge = {.text_bytes = MarkersUpload::kMost, .values = MarkersUpload::kMostValues};

Parts read_parts(codec::BodyDecoder& decoder, const icd::Rules& rules) {
  const auto document = ADIT_TRY(decoder.finish());
  return codec::read_markers_parts(document, rules);
}

bool is_too_large(const icd::Refusal& refusal) {
  return refusal.status == icd::Status::ContentTooLarge;
}

/// The worker's part. read_large() frees the body after it was decoded.
Parts read_small(codec::BodyKind kind, const icd::Rules& rules, const Body& body) {
  codec::BodyDecoder decoder(kind, codec::Split::Lists, kSmall);
  ADIT_TRY(decoder.feed(body));
  return read_parts(decoder, rules);
}

Parts read_large(codec::BodyKind kind, const icd::Rules& rules, Body& body) {
  codec::BodyDecoder decoder(kind, codec::Split::Lists, kLarge);
  ADIT_TRY(decoder.feed(body));
  Body().swap(body);
  return read_parts(decoder, rules);
}

}  // namespace

class MarkersUpload::State final : public LoopPart, public std::enable_shared_from_this<State> {
 public:
  State(UploadContext context, codec::BodyKind kind, const icd::Rules& rules, loop::Workers& workers,
        std::shared_ptr<UploadBudget> budget, const std::shared_ptr<TurnQueue>& turns)
      : LoopPart(std::move(context), std::move(budget)),
        kind_(kind),
        rules_(rules),
        workers_(workers),
        turns_(turns),
        at_once_(std::in_place, kind, codec::Split::Lists, kAtOnce) {}

  bool consume(std::span<const std::uint8_t> piece) override {
    if (!over_) keep(piece);
    return true;
  }
  void on_whole() override;

 private:
  void release_body() override { body_.clear(); }
  void keep(std::span<const std::uint8_t> piece);
  void feed(std::span<const std::uint8_t> piece);
  /// Charges the budget for the held bytes.
  void charge();
  void give_to_worker();
  void on_small_body(std::shared_ptr<Body> body, Parts parts);
  void wait_for_turn();
  void read_large_one();
  void on_read(Parts parts) {
    if (over_) return;
    if (!loop::run_guarded("receiving markers", [&] { on_decoded(std::move(parts)); }))
      fail(no_memory_refusal());
  }
  void end_turn() {
    if (const auto turns = turns_.lock()) turns->end();
  }
  /// Passes on the accepted markers. If the handler accepts them, the answer is about the rejected ones.
  void on_decoded(Parts parts) {
    abandon();
    if (!parts) return context_.refuse(parts.error());
    context_.message_handler.accept(
        std::move(parts->message), context_.sender_at_end(),
        [self = shared_from_this(), refused = std::move(parts->refused)](icd::Checked<void> taken) {
          if (taken && refused.count > 0) taken = std::unexpected(refused.refusal());
          self->context_.answer(taken);
        });
  }
  static icd::Refusal no_memory_refusal() {
    return {icd::Status::ServiceUnavailable, "Adit has no memory for these markers; send them again later"};
  }
  void on_failed() { reject(no_memory_refusal()); }

  codec::BodyKind kind_;
  icd::Rules rules_;
  loop::Workers& workers_;
  std::weak_ptr<TurnQueue> turns_;             // its turns hold this object
  Body body_;                                  // as received
  std::optional<codec::BodyDecoder> at_once_;  // nullopt: a worker decodes the update
};

void MarkersUpload::State::charge() {
  if (share_.grow_to(context_.sender.bytes + (at_once_ ? at_once_->size() : 0))) return;
  reject({icd::Status::TooManyRequests, "too many markers at once; send these markers again later"});
}

void MarkersUpload::State::keep(std::span<const std::uint8_t> piece) {
  context_.sender.bytes += piece.size();
  if (context_.sender.bytes > kMost) {
    return reject({icd::Status::ContentTooLarge, icd::sentence("body: expected at most ", kMost, " bytes")});
  }
  body_.insert(body_.end(), piece.begin(), piece.end());
  if (at_once_) feed(piece);
  if (!over_) charge();
}

void MarkersUpload::State::feed(std::span<const std::uint8_t> piece) {
  const auto fed = at_once_->feed(piece);
  if (fed) return;
  if (!is_too_large(fed.error())) return reject(fed.error());
  at_once_.reset();
}

void MarkersUpload::State::on_whole() {
  if (over_) return;
  if (body_.size() > kSmall.text_bytes) return wait_for_turn();
  if (!at_once_) return give_to_worker();
  on_decoded(read_parts(*at_once_, rules_));
}

void MarkersUpload::State::give_to_worker() {
  auto body = std::make_shared<Body>(std::exchange(body_, {}));
  auto parts = std::make_shared<Parts>();
  workers_.submit(
      loop::Urgency::OnTheWay,
      [kind = kind_, rules = rules_, body, parts] { *parts = read_small(kind, rules, *body); },
      [self = shared_from_this(), body, parts] { self->on_small_body(body, std::move(*parts)); },
      [self = shared_from_this()] { self->on_failed(); });
}

void MarkersUpload::State::on_small_body(std::shared_ptr<Body> body, Parts parts) {
  if (over_) return;
  if (parts || !is_too_large(parts.error())) return on_read(std::move(parts));
  body_ = std::move(*body);
  if (!loop::run_guarded("reading markers", [this] { wait_for_turn(); })) on_failed();
}

void MarkersUpload::State::wait_for_turn() {
  const auto turns = turns_.lock();
  if (!turns) return;
  turns->wait(context_.sender.address, [self = shared_from_this()] {
    if (self->over_) return self->end_turn();
    if (loop::run_guarded("reading markers", [&] { self->read_large_one(); })) return;
    self->end_turn();
    self->on_failed();
  });
}

void MarkersUpload::State::read_large_one() {
  auto body = std::make_shared<Body>(std::exchange(body_, {}));
  auto parts = std::make_shared<Parts>();
  workers_.submit(
      loop::Urgency::OnTheWay,
      [kind = kind_, rules = rules_, body, parts] { *parts = read_large(kind, rules, *body); },
      [self = shared_from_this(), parts] {
        self->end_turn();
        self->on_read(std::move(*parts));
      },
      [self = shared_from_this()] {
        self->end_turn();
        self->on_failed();
      });
}

MarkersUpload::MarkersUpload(const UploadContext& context, codec::BodyKind kind, const icd::Rules& rules,
                             loop::Workers& workers, std::shared_ptr<UploadBudget> budget,
                             const std::shared_ptr<TurnQueue>& turns)
    : WorkerUpload(context,
                   std::make_shared<State>(context, kind, rules, workers, std::move(budget), turns)) {}

}  // namespace adit::intake
