#include "intake/markers_upload.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "icd/sentence.hpp"
#include "intake/memory_given_back.hpp"
#include "intake/take_parts.hpp"
#include "loop/guard.hpp"

namespace adit::intake {
namespace {

using Body = std::vector<std::vector<std::uint8_t>>;
using Parts = icd::Checked<codec::InParts<icd::MarkersUpdate>>;

Parts read_parts(codec::BodyDecoder& decoder, const icd::Rules& rules) {
  const auto document = decoder.finish();
  if (!document) return std::unexpected(document.error());
  return codec::read_markers_parts(*document, rules);
}

/// The worker's part. What has been fed is freed.
Parts read_large(codec::BodyKind kind, const icd::Rules& rules, Body& body) {
  const MemoryGivenBack at_the_end(true);
  codec::BodyDecoder decoder(kind, codec::Split::Lists,
                             {.text_bytes = MarkersUpload::kMost, .values = MarkersUpload::kMostValues});
  for (auto& piece : body) {
    if (auto fed = decoder.feed(piece); !fed) return std::unexpected(std::move(fed.error()));
    std::vector<std::uint8_t>().swap(piece);
  }
  return read_parts(decoder, rules);
}

}  // namespace

class MarkersUpload::State final : public Taking, public std::enable_shared_from_this<State> {
 public:
  State(Visit visit, codec::BodyKind kind, const icd::Rules& rules, loop::Workers& workers,
        std::shared_ptr<UploadBudget> budget, const std::shared_ptr<OneAtATime>& turns)
      : Taking(std::move(visit), std::move(budget)),
        kind_(kind),
        rules_(rules),
        workers_(workers),
        turns_(turns),
        small_(std::in_place, kind, codec::Split::Lists, codec::Limits{.values = kSmallValues}) {}

  bool take(std::span<const std::uint8_t> piece) override {
    if (!over_) keep(piece);
    return true;
  }
  void whole() override;

 private:
  void let_go() override { body_.clear(); }
  void keep(std::span<const std::uint8_t> piece);
  void feed(std::span<const std::uint8_t> piece);
  /// For what it holds.
  void charge();
  void read();
  void give_to_worker();
  void read_by_worker(const Parts& parts) {
    end_turn();
    if (over_) return;
    if (!loop::guarded("taking markers", [&] { decoded(parts); })) fail(not_held());
  }
  void end_turn() {
    if (const auto turns = turns_.lock()) turns->end();
  }
  void decoded(const Parts& parts) {
    abandon();
    take_parts(visit_, parts);
  }
  static icd::Refusal not_held() {
    return {icd::Status::ServiceUnavailable,
            "the gateway could not hold these markers; send them again later"};
  }
  void failed() { turn_away(not_held()); }

  MemoryGivenBack at_the_end_{false};  // the first, and so after the rest
  codec::BodyKind kind_;
  icd::Rules rules_;
  loop::Workers& workers_;
  std::weak_ptr<OneAtATime> turns_;          // whose turns hold this
  Body body_;                                // as it came
  std::optional<codec::BodyDecoder> small_;  // nothing: it is large
};

void MarkersUpload::State::charge() {
  if (share_.grow_to(visit_.sender.bytes + (small_ ? small_->size() : 0))) return;
  turn_away({icd::Status::TooManyRequests, "too much is being sent at once; send these markers again later"});
}

void MarkersUpload::State::keep(std::span<const std::uint8_t> piece) {
  visit_.sender.bytes += piece.size();
  if (visit_.sender.bytes > kMost) {
    return turn_away(
        {icd::Status::ContentTooLarge, icd::sentence("body: expected at most ", kMost, " bytes")});
  }
  body_.emplace_back(piece.begin(), piece.end());
  if (small_) feed(piece);
  if (!over_) charge();
}

void MarkersUpload::State::feed(std::span<const std::uint8_t> piece) {
  const auto fed = small_->feed(piece);
  if (fed) return;
  if (fed.error().status != icd::Status::ContentTooLarge) return turn_away(fed.error());
  small_.reset();
  at_the_end_.expect_much();
}

void MarkersUpload::State::whole() {
  if (over_) return;
  if (!small_) {
    if (const auto turns = turns_.lock()) {
      turns->wait(visit_.sender.address, [self = shared_from_this()] { self->read(); });
    }
    return;
  }
  const MemoryGivenBack at_the_end(*small_);
  const Parts parts = read_parts(*small_, rules_);
  decoded(parts);
}

/// It is its turn.
void MarkersUpload::State::read() {
  const bool well = loop::guarded("reading markers", [this] { over_ ? end_turn() : give_to_worker(); });
  if (well) return;
  end_turn();
  failed();
}

void MarkersUpload::State::give_to_worker() {
  auto body = std::make_shared<Body>(std::exchange(body_, {}));
  auto parts = std::make_shared<Parts>();
  workers_.submit([kind = kind_, rules = rules_, body, parts] { *parts = read_large(kind, rules, *body); },
                  [self = shared_from_this(), parts] { self->read_by_worker(*parts); },
                  [self = shared_from_this()] {
                    self->end_turn();
                    self->failed();
                  });
}

MarkersUpload::MarkersUpload(Visit visit, codec::BodyKind kind, const icd::Rules& rules,
                             loop::Workers& workers, std::shared_ptr<UploadBudget> budget,
                             const std::shared_ptr<OneAtATime>& turns, std::shared_ptr<UnderWay> under_way)
    : WorkerUpload(std::make_shared<State>(std::move(visit), kind, rules, workers, std::move(budget), turns),
                   std::move(under_way)) {}

}  // namespace adit::intake
