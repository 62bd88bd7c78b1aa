#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "icd/chunked_bytes.hpp"

namespace adit::codec {

/// Whether a registered tag only annotates: a text, number, bytes, an array or a map keeps its meaning.
bool is_remark(std::uint64_t tag);

/// Whether a tag refers to an earlier text or value, so that a member's name may be under it.
bool is_reference(std::uint64_t tag);

/// Describes a tag that is no remark for a sentence.
std::string tag_that_changes(std::uint64_t tag);

/// Major types (RFC 8949 3.1).
enum class Major : std::uint8_t { Unsigned, Negative, Bytes, Text, Array, Map, Tag, Simple };

/// The head of a CBOR item (RFC 8949 section 3), its first byte and argument, read in pieces of any size.
class CborHead {
 public:
  /// Reads `in` and returns the number of bytes that belong to the head. Requires !complete().
  std::size_t next(std::string_view in);

  bool empty() const { return size_ == 0; }
  bool complete() const { return size_ > 0 && size_ == length(); }
  void clear() { size_ = 0; }

  // For a complete head:
  Major major() const { return static_cast<Major>(bytes_[0] >> 5); }
  std::uint8_t info() const { return bytes_[0] & 0x1F; }
  bool indefinite() const { return info() == 31; }
  bool is_break() const { return bytes_[0] == 0xFF; }
  /// Additional information that RFC 8949 reserves.
  bool is_reserved() const { return info() >= 28 && info() <= 30; }
  std::uint64_t argument() const;
  /// The value of a floating-point item (major type 7, info 25 to 27).
  double number() const;
  std::string_view raw() const { return {reinterpret_cast<const char*>(bytes_.data()), size_}; }

 private:
  std::size_t length() const {
    return info() >= 24 && info() <= 27 ? 1 + (std::size_t{1} << (info() - 24)) : 1;
  }

  std::array<std::uint8_t, 9> bytes_{};
  std::size_t size_ = 0;
};

/// Writes CBOR (RFC 8949) with the shortest definite lengths (4.1). Write as many items as announced.
class CborWriter {
 public:
  void map(std::size_t members) { head(Major::Map, members); }
  void array(std::size_t elements) { head(Major::Array, elements); }
  void text(std::string_view utf8);
  void integer(std::int64_t number);
  /// Always a 64-bit float, so that the reader gets a float.
  void floating(double number) {
    head(Major::Simple, 27, std::bit_cast<std::uint64_t>(number), sizeof number);
  }
  void boolean(bool yes) { head(Major::Simple, yes ? 21 : 20); }
  /// A byte string that shares the chunks of `bytes`.
  void byte_string(const icd::ChunkedBytes& bytes);

  icd::ChunkedBytes finish();

 private:
  void head(Major major, std::uint8_t info, std::uint64_t number, std::size_t size);
  void head(Major major, std::uint64_t argument);
  void flush() { out_.append(std::span(latest_).first(std::exchange(used_, 0))); }

  icd::ChunkedBytes out_;
  std::array<std::uint8_t, 4096> latest_;  // buffer, because items are small
  std::size_t used_ = 0;
};

}  // namespace adit::codec
