#pragma once

#include <malloc.h>

#include "codec/body_decoder.hpp"

namespace adit::intake {

/// Returns memory to the system after a large document. Otherwise memory that was freed in many small pieces
/// stays with the process, once for each thread.
class MemoryGivenBack {
 public:
  explicit MemoryGivenBack(bool is_large) : is_large_(is_large) {}
  explicit MemoryGivenBack(const codec::BodyDecoder& decoder) : MemoryGivenBack(decoder.size() > kLarge) {}
  ~MemoryGivenBack() {
    if (is_large_) ::malloc_trim(0);
  }
  MemoryGivenBack(const MemoryGivenBack&) = delete;
  MemoryGivenBack& operator=(const MemoryGivenBack&) = delete;

  /// The document is large.
  void expect_much() { is_large_ = true; }

 private:
  static constexpr std::size_t kLarge = std::size_t{64} * 1024;

  bool is_large_;
};

}  // namespace adit::intake
