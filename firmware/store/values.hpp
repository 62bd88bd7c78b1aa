#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace adit::store {

/// Puts numbers and texts of a record one after the other: a number in 8 bytes, little-endian; a real as the
/// bits of its IEEE 754 double; a text behind its size, a number.
class Writer {
 public:
  Writer& number(std::uint64_t number);
  Writer& real(double real);
  Writer& text(std::string_view text);
  std::string finish() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads the bytes of a Writer. A value behind their end reads as 0 or "", and ok() is false from then on.
class Reader {
 public:
  explicit Reader(std::string_view bytes) : left_(bytes) {}
  std::uint64_t number();
  double real();
  std::string_view text();
  bool ok() const { return ok_; }
  bool at_end() const { return left_.empty(); }
  std::string_view left() const { return left_; }

 private:
  std::string_view take(std::size_t size);

  std::string_view left_;
  bool ok_ = true;
};

}  // namespace adit::store
