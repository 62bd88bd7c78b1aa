#include "intake/map_upload.hpp"

#include <optional>
#include <string>
#include <utility>

#include "codec/read.hpp"
#include "icd/map_update.hpp"
#include "icd/sentence.hpp"

namespace adit::intake {
namespace {

using Pieces = std::vector<std::vector<std::uint8_t>>;

/// The worker's part: touched by nobody else while a piece of work is under way.
class Decoding {
 public:
  Decoding(codec::BodyKind kind, const icd::Rules& rules)
      : rules_(rules), decoder_(kind, codec::Split::MapData, {.data_bytes = rules.map_bytes}) {}

  void work(Pieces& pieces, bool whole) {
    for (auto& piece : pieces) {
      if (auto fed = decoder_.feed(piece); !fed) {
        result_ = std::unexpected(std::move(fed.error()));
        return;
      }
      std::vector<std::uint8_t>().swap(piece);
    }
    if (!whole) return;
    auto document = decoder_.finish();
    if (!document) {
      result_ = std::unexpected(std::move(document.error()));
    } else {
      result_ = codec::read_map_update(std::move(*document), rules_);
    }
  }

  /// Nothing while more of the body is to come.
  std::optional<icd::Checked<icd::MapUpdate>>& result() { return result_; }

 private:
  icd::Rules rules_;
  codec::BodyDecoder decoder_;
  std::optional<icd::Checked<icd::MapUpdate>> result_;
};

}  // namespace

/// The loop's part: outlives the exchange for as long as a worker is at it.
class MapUpload::State : public std::enable_shared_from_this<State> {
 public:
  State(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow, loop::Workers& workers,
        std::shared_ptr<UploadBudget> budget)
      : visit_(std::move(visit)),
        options_(options),
        flow_(std::move(flow)),
        workers_(workers),
        budget_(std::move(budget)),
        decoding_(std::make_shared<Decoding>(options.kind, options.rules)) {
    visit_.sender.bytes = 0;
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { budget_->give_back(taken_); }

  bool take(std::span<const std::uint8_t> piece);
  void whole() {
    whole_ = true;
    give_to_worker();
  }
  void abandon() {
    over_ = true;
    pending_.clear();
  }

 private:
  void give_to_worker();
  void worked();
  void refuse(icd::Status status, std::string sentence) {
    abandon();
    visit_.refuse({status, std::move(sentence)});
  }

  Visit visit_;
  MapUploadOptions options_;
  std::shared_ptr<Flow> flow_;
  loop::Workers& workers_;
  std::shared_ptr<UploadBudget> budget_;
  std::shared_ptr<Decoding> decoding_;
  std::size_t taken_ = 0;  // of the budget
  Pieces pending_;
  std::size_t pending_bytes_ = 0;
  bool at_work_ = false;
  bool held_back_ = false;
  bool whole_ = false;
  bool over_ = false;  // answered, or the client is gone
};

bool MapUpload::State::take(std::span<const std::uint8_t> piece) {
  if (over_) return true;
  visit_.sender.bytes += piece.size();
  if (visit_.sender.bytes > options_.most_bytes) {
    refuse(icd::Status::ContentTooLarge,
           icd::sentence("body: expected at most ", options_.most_bytes, " bytes"));
    return true;
  }
  if (!budget_->take(piece.size())) {
    refuse(icd::Status::TooManyRequests, "too many maps are being sent at once; send this one again later");
    return true;
  }
  taken_ += piece.size();
  pending_.emplace_back(piece.begin(), piece.end());
  pending_bytes_ += piece.size();
  if (options_.kind.coding != codec::ContentCoding::Identity) return true;
  give_to_worker();
  held_back_ = pending_bytes_ > kPending;
  return !held_back_;
}

void MapUpload::State::give_to_worker() {
  if (at_work_ || over_ || (pending_.empty() && !whole_)) return;
  at_work_ = true;
  auto pieces = std::make_shared<Pieces>(std::exchange(pending_, {}));
  pending_bytes_ = 0;
  workers_.submit([decoding = decoding_, pieces, whole = whole_] { decoding->work(*pieces, whole); },
                  [self = shared_from_this()] { self->worked(); });
}

void MapUpload::State::worked() {
  at_work_ = false;
  if (over_) return;
  if (auto& result = decoding_->result()) {
    abandon();
    visit_.answer(*result ? visit_.desk.take(std::move(**result), visit_.sender)
                          : std::unexpected(std::move(result->error())));
    return;
  }
  give_to_worker();
  if (std::exchange(held_back_, false)) flow_->resume();
}

MapUpload::MapUpload(Visit visit, MapUploadOptions options, std::shared_ptr<Flow> flow,
                     loop::Workers& workers, std::shared_ptr<UploadBudget> budget)
    : state_(
          std::make_shared<State>(std::move(visit), options, std::move(flow), workers, std::move(budget))) {}

MapUpload::~MapUpload() {
  state_->abandon();
}

bool MapUpload::on_body(std::span<const std::uint8_t> piece) {
  return state_->take(piece);
}

void MapUpload::on_end() {
  state_->whole();
}

void MapUpload::on_gone() {
  state_->abandon();
}

}  // namespace adit::intake
