#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

#include "codec/cbor_head.hpp"
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
  void head(Major major, std::uint8_t info, std::uint64_t number, std::size_t size);
  void head(Major major, std::uint64_t argument);

  icd::ChunkedBytes out_;
};

}  // namespace adit::codec
