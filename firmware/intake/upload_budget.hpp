#pragma once

#include <cstddef>
#include <memory>
#include <utility>

namespace adit::intake {

/// How much all maps and large markers under way together may take, so that many at once cannot use up the
/// memory. For the loop alone.
class UploadBudget {
 public:
  explicit UploadBudget(std::size_t bytes) : left_(bytes) {}
  bool take(std::size_t bytes) {
    if (bytes > left_) return false;
    left_ -= bytes;
    return true;
  }
  void give_back(std::size_t bytes) { left_ += bytes; }

 private:
  std::size_t left_;
};

/// What one upload has taken of the budget. Its end gives it back.
class UploadShare {
 public:
  explicit UploadShare(std::shared_ptr<UploadBudget> budget) : budget_(std::move(budget)) {}
  ~UploadShare() { budget_->give_back(taken_); }
  UploadShare(const UploadShare&) = delete;
  UploadShare& operator=(const UploadShare&) = delete;

  /// False: not so much is left, and nothing more is taken.
  bool take(std::size_t bytes) {
    if (!budget_->take(bytes)) return false;
    taken_ += bytes;
    return true;
  }
  /// Of what it has taken.
  void give_back(std::size_t bytes) {
    taken_ -= bytes;
    budget_->give_back(bytes);
  }

 private:
  std::shared_ptr<UploadBudget> budget_;
  std::size_t taken_ = 0;
};

}  // namespace adit::intake
