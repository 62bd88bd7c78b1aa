#pragma once

#include <cstddef>

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

}  // namespace adit::intake
