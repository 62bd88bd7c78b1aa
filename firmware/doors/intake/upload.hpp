#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "icd/status.hpp"
#include "intake/visit.hpp"

namespace adit::intake {

/// Limits the memory of all uploads together. Above three quarters, an address may take bytes only if it then
/// holds no more than is left. So an address that sends much leaves room for others. For the loop only.
class UploadBudget {
 public:
  explicit UploadBudget(std::size_t bytes) : whole_(bytes), left_(bytes) {}

  /// Takes bytes for `address`. False: the budget or the share of `address` is used up.
  bool take(const std::string& address, std::size_t bytes) {
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
    if (!budget_->take(address_, bytes - taken_)) return false;
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
    go_on();
  }
  void end() {
    under_way_ = false;
    go_on();
  }

 private:
  struct Line {
    std::string address;
    std::deque<std::function<void()>> waiting;  // not empty
  };

  void go_on() {
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
  explicit Upload(const Visit& visit)
      : uploads_(visit.uploads), uri_(visit.uri), address_(visit.sender.address), began_(visit.sender.began) {
    uploads_->under_way.insert(this);
  }
  ~Upload() override { uploads_->under_way.erase(this); }
  Upload(const Upload&) = delete;
  Upload& operator=(const Upload&) = delete;

  /// Rejects the message, unless the desk has it and will answer it.
  virtual void turn_away(const icd::Refusal& refusal) = 0;

  /// Whether it is of the same address and URI.
  bool is_like(const Visit& visit) const { return uri_ == visit.uri && address_ == visit.sender.address; }
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
  class Taking {
   public:
    Taking(Visit visit, std::shared_ptr<UploadBudget> budget)
        : visit_(std::move(visit)), share_(std::move(budget), visit_.sender.address) {
      visit_.sender.bytes = 0;
    }
    virtual ~Taking() = default;
    Taking(const Taking&) = delete;
    Taking& operator=(const Taking&) = delete;

    /// As BodySink::on_body().
    virtual bool take(std::span<const std::uint8_t> piece) = 0;
    virtual void whole() = 0;
    void abandon() {
      over_ = true;
      let_go();
    }
    void turn_away(const icd::Refusal& refusal) {
      if (over_) return;
      abandon();
      visit_.refuse(refusal);
    }

   protected:
    /// Rejects the message after the last step has failed, even if the desk has it.
    void fail(const icd::Refusal& refusal) {
      abandon();
      visit_.refuse(refusal);
    }

    Visit visit_;
    UploadShare share_;
    bool over_ = false;  // answered, the client is gone, or the desk has it

   private:
    /// Frees the held parts of the body.
    virtual void let_go() = 0;
  };

  WorkerUpload(const Visit& visit, std::shared_ptr<Taking> taking)
      : Upload(visit), taking_(std::move(taking)) {}
  ~WorkerUpload() override { taking_->abandon(); }
  WorkerUpload(const WorkerUpload&) = delete;
  WorkerUpload& operator=(const WorkerUpload&) = delete;

  bool on_body(std::span<const std::uint8_t> piece) final { return taking_->take(piece); }
  void on_end() final { taking_->whole(); }
  void on_gone() final { taking_->abandon(); }
  void turn_away(const icd::Refusal& refusal) final { taking_->turn_away(refusal); }

 private:
  std::shared_ptr<Taking> taking_;
};

}  // namespace adit::intake
