#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "codec/cbor_head.hpp"
#include "icd/chunked_bytes.hpp"

namespace adit::codec {

/// Writes CBOR items (RFC 8949) with the shortest definite lengths (4.1). The caller must write as many items
/// as announced.
class CborWriter {
 public:
  void map(std::size_t members);
  void array(std::size_t elements);
  void text(std::string_view utf8);
  void whole(std::int64_t number);
  /// Always a 64-bit float, so that the reader gets a float.
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
  std::array<std::uint8_t, 4096> latest_;  // buffer, because items are small
  std::size_t used_ = 0;
};

}  // namespace adit::codec
