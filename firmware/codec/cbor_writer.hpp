#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

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

  icd::ChunkedBytes finish();

 private:
  void head(Major major, std::uint8_t info, std::uint64_t number, std::size_t size);
  void head(Major major, std::uint64_t argument);
  void flush();

  icd::ChunkedBytes out_;
  std::array<std::uint8_t, 4096> latest_;  // what follows, together: an item is a few bytes
  std::size_t used_ = 0;
};

}  // namespace adit::codec
