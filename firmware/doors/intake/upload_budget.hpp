#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <utility>

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

}  // namespace adit::intake
