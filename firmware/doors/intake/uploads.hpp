#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>

#include "codec/body_decoder.hpp"
#include "icd/rules.hpp"
#include "icd/status.hpp"
#include "intake/message_handler.hpp"
#include "intake/server.hpp"
#include "loop/workers.hpp"

namespace adit::intake {

class Upload;

/// All uploads that are not over. For the loop only.
struct Uploads {
  std::set<Upload*> under_way;
  std::uint64_t last = 0;  // place of the last beginning or end (Sender::began)
};

/// One request to one of the ICD's URIs: its sender, and the responder for the answer.
struct UploadContext {
  MessageHandler& message_handler;
  icd::Uri uri;
  Sender sender;
  std::shared_ptr<Responder> responder;
  std::shared_ptr<Uploads> uploads;

  /// The sender of an upload that is whole now.
  Sender sender_at_end() const;

  void refuse(const icd::Refusal& refusal, std::vector<Header> headers = {}) const;
  /// 200 `null`, or the refusal.
  void answer(const icd::Checked<void>& taken) const;
};

/// Limits the memory of all uploads together. Above three quarters, an address may take bytes only if it then
/// holds no more than is left. So an address that sends much leaves room for others. For the loop only.
class UploadBudget {
 public:
  explicit UploadBudget(std::size_t bytes) : whole_(bytes), left_(bytes) {}

  /// Takes bytes for `address`. False: the budget or the share of `address` is used up.
  bool reserve(const std::string& address, std::size_t bytes) {
    if (!is_fair(address, bytes)) return false;
    left_ -= bytes;
    held_[address] += bytes;
    return true;
  }
  void give_back(const std::string& address, std::size_t bytes) {
    left_ += bytes;
    const auto held = held_.find(address);
    if (held == held_.end()) return;
    held->second -= bytes;
    if (held->second == 0) held_.erase(held);
  }

 private:
  bool is_fair(const std::string& address, std::size_t bytes) const {
    if (bytes > left_) return false;
    const std::size_t left = left_ - bytes;
    const auto held = held_.find(address);
    return left >= whole_ / 4 || bytes + (held == held_.end() ? 0 : held->second) <= left;
  }

  const std::size_t whole_;
  std::size_t left_;
  std::map<std::string, std::size_t> held_;  // by address
};

/// The part of the budget that one upload holds. The destructor gives it back.
class UploadShare {
 public:
  UploadShare(std::shared_ptr<UploadBudget> budget, std::string address)
      : budget_(std::move(budget)), address_(std::move(address)) {}
  ~UploadShare() { budget_->give_back(address_, taken_); }
  UploadShare(const UploadShare&) = delete;
  UploadShare& operator=(const UploadShare&) = delete;

  /// Grows the part to `bytes`. False: the budget does not allow it, and the part stays as it is.
  bool grow_to(std::size_t bytes) {
    if (bytes <= taken_) return true;
    if (!budget_->reserve(address_, bytes - taken_)) return false;
    taken_ = bytes;
    return true;
  }

 private:
  std::shared_ptr<UploadBudget> budget_;
  const std::string address_;
  std::size_t taken_ = 0;
};

/// Gives turns for work that needs too much memory to be done twice at once. Addresses take turns; each
/// address has its turns in order of arrival. For the loop only.
class TurnQueue {
 public:
  /// Calls `begin` when its turn comes, maybe at once. The caller ends the turn with end().
  void wait(const std::string& address, std::function<void()> begin) {
    auto line = std::ranges::find(lines_, address, &Line::address);
    if (line == lines_.end()) line = lines_.insert(line, {.address = address, .waiting = {}});
    line->waiting.push_back(std::move(begin));
    start_next();
  }
  void end() {
    under_way_ = false;
    start_next();
  }

 private:
  struct Line {
    std::string address;
    std::deque<std::function<void()>> waiting;  // not empty
  };

  void start_next() {
    if (under_way_ || lines_.empty()) return;
    under_way_ = true;
    Line first = std::move(lines_.front());
    lines_.pop_front();
    const auto begin = std::move(first.waiting.front());
    first.waiting.pop_front();
    if (!first.waiting.empty()) lines_.push_back(std::move(first));
    begin();
  }

  std::deque<Line> lines_;
  bool under_way_ = false;
};

/// The most values of a small document (codec::Limits): 25 MiB at worst.
inline constexpr std::size_t kSmallValues = 100'000;

/// Receives the body of a message. It can be rejected before the body is whole.
class Upload : public BodySink {
 public:
  explicit Upload(const UploadContext& context)
      : uploads_(context.uploads),
        uri_(context.uri),
        address_(context.sender.address),
        began_(context.sender.began) {
    uploads_->under_way.insert(this);
  }
  ~Upload() override { uploads_->under_way.erase(this); }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// Rejects the message, unless the message handler has it and will answer it.
  virtual void reject(const icd::Refusal& refusal) = 0;

  /// Whether it is of the same address and URI.
  bool is_same_source(const UploadContext& context) const {
    return uri_ == context.uri && address_ == context.sender.address;
  }
  std::uint64_t began() const { return began_; }

 private:
  std::shared_ptr<Uploads> uploads_;
  icd::Uri uri_;
  std::string address_;
  std::uint64_t began_;
};

/// An upload that a worker decodes.
class WorkerUpload : public Upload {
 public:
  /// The loop's part. It outlives the upload while a worker runs.
  class LoopPart {
   public:
    LoopPart(UploadContext context, std::shared_ptr<UploadBudget> budget)
        : context_(std::move(context)), share_(std::move(budget), context_.sender.address) {
      context_.sender.bytes = 0;
    }
    virtual ~LoopPart() = default;
    LoopPart(const LoopPart&) = delete;
    LoopPart& operator=(const LoopPart&) = delete;

    /// As BodySink::on_body().
    virtual bool consume(std::span<const std::uint8_t> piece) = 0;
    virtual void on_whole() = 0;
    void abandon() {
      over_ = true;
      release_body();
    }
    void reject(const icd::Refusal& refusal) {
      if (over_) return;
      abandon();
      context_.refuse(refusal);
    }

   protected:
    /// Rejects the message after the last step has failed, even if the message handler has it.
    void fail(const icd::Refusal& refusal) {
      abandon();
      context_.refuse(refusal);
    }

    UploadContext context_;
    UploadShare share_;
    bool over_ = false;  // answered, the client is gone, or the message handler has it

   private:
    virtual void release_body() = 0;
  };

  WorkerUpload(const UploadContext& context, std::shared_ptr<LoopPart> taking)
      : Upload(context), taking_(std::move(taking)) {}
  ~WorkerUpload() override { taking_->abandon(); }
  WorkerUpload(const WorkerUpload&) = delete;
  WorkerUpload& operator=(const WorkerUpload&) = delete;

  bool on_body(std::span<const std::uint8_t> piece) final { return taking_->consume(piece); }
  void on_end() final { taking_->on_whole(); }
  void on_gone() final { taking_->abandon(); }
  void reject(const icd::Refusal& refusal) final { taking_->reject(refusal); }

 private:
  std::shared_ptr<LoopPart> taking_;
};

/// Receives a state or a report of at most a megabyte. The loop decodes it as it arrives.
class SmallUpload final : public Upload {
 public:
  SmallUpload(UploadContext context, codec::BodyKind kind, const icd::Rules& rules,
              std::shared_ptr<UploadBudget> budget)
      : Upload(context),
        context_(std::move(context)),
        share_(std::move(budget), context_.sender.address),
        rules_(rules),
        decoder_(kind, codec::Split::Nothing, {.values = kSmallValues}) {
    context_.sender.bytes = 0;
  }

  bool on_body(std::span<const std::uint8_t> piece) override;
  void on_end() override;
  void reject(const icd::Refusal& refusal) override {
    if (!whole_) context_.refuse(refusal);
  }

 private:
  void give_to_handler(const codec::Document& document);
  /// Passes on the accepted parts. If the handler accepts them, the answer is about the rejected ones.
  void accept_state(const codec::Document& document);
  void accept_report(const codec::Document& document);

  UploadContext context_;
  UploadShare share_;
  icd::Rules rules_;
  codec::BodyDecoder decoder_;
  bool whole_ = false;
};

struct MapUploadOptions {
  codec::BodyKind kind;
  icd::Rules rules;
  std::size_t most_bytes = 0;                  // the most of the body
  std::shared_ptr<UploadBudget> without_room;  // for maps that are held because they cannot be stored
};

/// Receives a map. A worker decodes the body as it arrives, one job at a time. The client must wait while
/// more than kPending bytes wait for the worker. Decoded data is stored kStored bytes or more at a time. If
/// as much again is decoded before that is stored, the worker pauses. So a large map is never in memory as a
/// whole. If a grid says before its data that it is a grid, as most do, its cells are gzipped as they are
/// decoded (codec::PressedCells), and the map is nearly packed when its last byte arrives.
///
/// A compressed body may grow a thousandfold. It is decoded in steps of little more than kStored, and its
/// decoded size counts in the budget. If it cannot be stored, it stays in memory until it is checked. All
/// such maps together have kWithoutRoom; a map that needs more is rejected.
///
/// A whole, checked map goes to the message handler, which answers when the map is stored, even if the client
/// has hung up by then. If the client hangs up earlier, the map is dropped.
class MapUpload final : public WorkerUpload {
 public:
  static constexpr std::size_t kPending = 256 * 1024, kStored = 256 * 1024;
  static constexpr std::size_t kTogether =
      64 * 1024;  // the least bytes of a job, except at the beginning and the end
  static constexpr std::size_t kWithoutRoom = 24u << 20;

  MapUpload(const UploadContext& context, MapUploadOptions options, std::shared_ptr<FlowControl> flow,
            loop::Workers& workers, std::shared_ptr<UploadBudget> budget);

 private:
  class State;
};

/// Receives a markers update of at most kMost bytes, compressed or not.
///
/// The loop decodes an update of a few dozen markers as it arrives. Larger ones are kept as received, and a
/// worker decodes them when they are whole. An update that is larger than codec::Limits::text_bytes (a marker
/// may have icd::kMostMarkerPoints) or has more than kSmallValues takes much memory, so only one such update
/// is decoded at a time. No message is in memory as a tree: each marker and each of its points is parsed
/// separately.
///
/// A whole, checked update goes to the message handler, even if the client has hung up by then. If the client
/// hangs up earlier, the update is dropped.
class MarkersUpload final : public WorkerUpload {
 public:
  /// Enough for each possible marker: one of 100,000 points and as many colors takes 7.9 MB of CBOR.
  static constexpr std::size_t kMost = 8u << 20;
  /// Such a marker has 900,000 values without their names.
  static constexpr std::size_t kMostValues = 1'000'000;

  MarkersUpload(const UploadContext& context, codec::BodyKind kind, const icd::Rules& rules,
                loop::Workers& workers, std::shared_ptr<UploadBudget> budget,
                const std::shared_ptr<TurnQueue>& turns);

 private:
  class State;
};

}  // namespace adit::intake
