#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "icd/chunked_bytes.hpp"

namespace adit::codec {

/// CBOR (RFC 8949), item after item, each length in its shortest form (4.1) and none indefinite. The caller
/// writes as many items as it announced.
class CborWriter {
 public:
  void map(std::size_t members);
  void array(std::size_t elements);
  void text(std::string_view utf8);
  void whole(std::int64_t number);
  /// Always as a 64-bit float, so that a reader who asks for a float gets one.
  void real(double number);
  void truth(bool yes);
  /// A byte string that shares the chunks of `bytes`.
  void byte_string(const icd::ChunkedBytes& bytes);

  icd::ChunkedBytes finish() { return std::move(out_); }

 private:
  template <auto kEncode, class... Arguments>
  void head(Arguments... arguments);

  icd::ChunkedBytes out_;
};

}  // namespace adit::codec
