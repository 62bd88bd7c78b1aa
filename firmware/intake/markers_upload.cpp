#include "intake/markers_upload.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "icd/sentence.hpp"
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
  codec::BodyDecoder decoder(kind, codec::Split::Nothing, {.text_bytes = MarkersUpload::kMost});
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
        std::shared_ptr<UploadBudget> budget)
      : Taking(std::move(visit), std::move(budget)),
        kind_(kind),
        rules_(rules),
        workers_(workers),
        small_(std::in_place, kind, codec::Split::Nothing, codec::Limits{}) {}

  bool take(std::span<const std::uint8_t> piece) override {
    if (!over_) keep(piece);
    return true;
  }
  void whole() override;

 private:
  void let_go() override { body_.clear(); }
  void keep(std::span<const std::uint8_t> piece);
  void feed(std::span<const std::uint8_t> piece);
  /// False: it has been refused.
  bool charge(std::size_t bytes);
  void give_to_worker();
  void decoded(const Parts& parts) {
    if (over_) return;
    abandon();
    take_parts(visit_, parts);
  }
  void failed() {
    turn_away(
        {icd::Status::ServiceUnavailable, "the gateway could not hold these markers; send them again later"});
  }

  codec::BodyKind kind_;
  icd::Rules rules_;
  loop::Workers& workers_;
  Body body_;                                // as it came
  std::optional<codec::BodyDecoder> small_;  // nothing: it is large
};

bool MarkersUpload::State::charge(std::size_t bytes) {
  if (share_.take(bytes)) return true;
  turn_away({icd::Status::TooManyRequests, "too much is being sent at once; send these markers again later"});
  return false;
}

void MarkersUpload::State::keep(std::span<const std::uint8_t> piece) {
  visit_.sender.bytes += piece.size();
  if (visit_.sender.bytes > kMost) {
    return turn_away(
        {icd::Status::ContentTooLarge, icd::sentence("body: expected at most ", kMost, " bytes")});
  }
  if (!charge(piece.size())) return;
  body_.emplace_back(piece.begin(), piece.end());
  if (small_) feed(piece);
}

void MarkersUpload::State::feed(std::span<const std::uint8_t> piece) {
  const auto fed = small_->feed(piece);
  if (fed) return;
  if (fed.error().status != icd::Status::ContentTooLarge) return turn_away(fed.error());
  small_.reset();
  (void)charge(kReading);
}

void MarkersUpload::State::whole() {
  if (over_) return;
  if (!small_) return give_to_worker();
  const Parts parts = read_parts(*small_, rules_);
  decoded(parts);
}

void MarkersUpload::State::give_to_worker() {
  auto body = std::make_shared<Body>(std::exchange(body_, {}));
  auto parts = std::make_shared<Parts>();
  workers_.submit([kind = kind_, rules = rules_, body, parts] { *parts = read_large(kind, rules, *body); },
                  [self = shared_from_this(), parts] {
                    if (!loop::guarded("taking markers", [&] { self->decoded(*parts); })) self->failed();
                  },
                  [self = shared_from_this()] { self->failed(); });
}

MarkersUpload::MarkersUpload(Visit visit, codec::BodyKind kind, const icd::Rules& rules,
                             loop::Workers& workers, std::shared_ptr<UploadBudget> budget,
                             std::shared_ptr<UnderWay> under_way)
    : WorkerUpload(std::make_shared<State>(std::move(visit), kind, rules, workers, std::move(budget)),
                   std::move(under_way)) {}

}  // namespace adit::intake
