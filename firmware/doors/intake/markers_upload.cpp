#include "intake/markers_upload.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "codec/read.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/guard.hpp"

namespace adit::intake {
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

class MarkersUpload::State final : public Taking, public std::enable_shared_from_this<State> {
 public:
  State(Visit visit, codec::BodyKind kind, const icd::Rules& rules, loop::Workers& workers,
        std::shared_ptr<UploadBudget> budget, const std::shared_ptr<TurnQueue>& turns)
      : Taking(std::move(visit), std::move(budget)),
        kind_(kind),
        rules_(rules),
        workers_(workers),
        turns_(turns),
        at_once_(std::in_place, kind, codec::Split::Lists, kAtOnce) {}

  bool take(std::span<const std::uint8_t> piece) override {
    if (!over_) keep(piece);
    return true;
  }
  void whole() override;

 private:
  void let_go() override { body_.clear(); }
  void keep(std::span<const std::uint8_t> piece);
  void feed(std::span<const std::uint8_t> piece);
  /// Charges the budget for the held bytes.
  void charge();
  void give_to_worker();
  void small_was_read(std::shared_ptr<Body> body, Parts parts);
  void wait_for_turn();
  void read_large_one();
  void was_read(Parts parts) {
    if (over_) return;
    if (!loop::guarded("receiving markers", [&] { decoded(std::move(parts)); })) fail(not_held());
  }
  void end_turn() {
    if (const auto turns = turns_.lock()) turns->end();
  }
  /// Gives the accepted markers to the desk. If the desk accepts them, the answer is about the rejected ones.
  void decoded(Parts parts) {
    abandon();
    if (!parts) return visit_.refuse(parts.error());
    visit_.desk.take(
        std::move(parts->message), visit_.sender_at_end(),
        [self = shared_from_this(), refused = std::move(parts->refused)](icd::Checked<void> taken) {
          if (taken && refused.count > 0) taken = std::unexpected(refused.refusal());
          self->visit_.answer(taken);
        });
  }
  static icd::Refusal not_held() {
    return {icd::Status::ServiceUnavailable, "Adit has no memory for these markers; send them again later"};
  }
  void failed() { turn_away(not_held()); }

  codec::BodyKind kind_;
  icd::Rules rules_;
  loop::Workers& workers_;
  std::weak_ptr<TurnQueue> turns_;             // its turns hold this object
  Body body_;                                  // as received
  std::optional<codec::BodyDecoder> at_once_;  // nullopt: a worker decodes the update
};

void MarkersUpload::State::charge() {
  if (share_.grow_to(visit_.sender.bytes + (at_once_ ? at_once_->size() : 0))) return;
  turn_away({icd::Status::TooManyRequests, "too many markers at once; send these markers again later"});
}

void MarkersUpload::State::keep(std::span<const std::uint8_t> piece) {
  visit_.sender.bytes += piece.size();
  if (visit_.sender.bytes > kMost) {
    return turn_away(
        {icd::Status::ContentTooLarge, icd::sentence("body: expected at most ", kMost, " bytes")});
  }
  body_.insert(body_.end(), piece.begin(), piece.end());
  if (at_once_) feed(piece);
  if (!over_) charge();
}

void MarkersUpload::State::feed(std::span<const std::uint8_t> piece) {
  const auto fed = at_once_->feed(piece);
  if (fed) return;
  if (!is_too_large(fed.error())) return turn_away(fed.error());
  at_once_.reset();
}

void MarkersUpload::State::whole() {
  if (over_) return;
  if (body_.size() > kSmall.text_bytes) return wait_for_turn();
  if (!at_once_) return give_to_worker();
  decoded(read_parts(*at_once_, rules_));
}

void MarkersUpload::State::give_to_worker() {
  auto body = std::make_shared<Body>(std::exchange(body_, {}));
  auto parts = std::make_shared<Parts>();
  workers_.submit(
      loop::Urgency::OnTheWay,
      [kind = kind_, rules = rules_, body, parts] { *parts = read_small(kind, rules, *body); },
      [self = shared_from_this(), body, parts] { self->small_was_read(body, std::move(*parts)); },
      [self = shared_from_this()] { self->failed(); });
}

void MarkersUpload::State::small_was_read(std::shared_ptr<Body> body, Parts parts) {
  if (over_) return;
  if (parts || !is_too_large(parts.error())) return was_read(std::move(parts));
  body_ = std::move(*body);
  if (!loop::guarded("reading markers", [this] { wait_for_turn(); })) failed();
}

void MarkersUpload::State::wait_for_turn() {
  const auto turns = turns_.lock();
  if (!turns) return;
  turns->wait(visit_.sender.address, [self = shared_from_this()] {
    if (self->over_) return self->end_turn();
    if (loop::guarded("reading markers", [&] { self->read_large_one(); })) return;
    self->end_turn();
    self->failed();
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
        self->was_read(std::move(*parts));
      },
      [self = shared_from_this()] {
        self->end_turn();
        self->failed();
      });
}

MarkersUpload::MarkersUpload(const Visit& visit, codec::BodyKind kind, const icd::Rules& rules,
                             loop::Workers& workers, std::shared_ptr<UploadBudget> budget,
                             const std::shared_ptr<TurnQueue>& turns)
    : WorkerUpload(visit, std::make_shared<State>(visit, kind, rules, workers, std::move(budget), turns)) {}

}  // namespace adit::intake
