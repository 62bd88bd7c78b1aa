#include "codec/cbor_writer.hpp"

#include <bit>
#include <cstring>
#include <span>
#include <utility>

namespace adit::codec {

/// Writes the head, then `number` in `size` bytes, the highest first.
void CborWriter::head(Major major, std::uint8_t info, std::uint64_t number, std::size_t size) {
  if (latest_.size() - used_ < 1 + sizeof number) flush();
  latest_[used_++] = static_cast<std::uint8_t>(static_cast<unsigned>(major) << 5 | info);
  if (size == 0) return;
  number <<= 8 * (sizeof number - size);
  if constexpr (std::endian::native == std::endian::little) number = std::byteswap(number);
  std::memcpy(&latest_[used_], &number, sizeof number);
  used_ += size;
}

void CborWriter::head(Major major, std::uint64_t argument) {
  if (argument < 24) return head(major, static_cast<std::uint8_t>(argument), 0, 0);
  if (argument <= 0xFF) return head(major, 24, argument, 1);
  if (argument <= 0xFFFF) return head(major, 25, argument, 2);
  if (argument <= 0xFFFF'FFFF) return head(major, 26, argument, 4);
  head(major, 27, argument, 8);
}

void CborWriter::map(std::size_t members) {
  head(Major::Map, members);
}

void CborWriter::array(std::size_t elements) {
  head(Major::Array, elements);
}

void CborWriter::text(std::string_view utf8) {
  head(Major::Text, utf8.size());
  if (utf8.size() > latest_.size() - used_) flush();
  if (utf8.size() > latest_.size())
    return out_.append({reinterpret_cast<const std::uint8_t*>(utf8.data()), utf8.size()});
  utf8.copy(reinterpret_cast<char*>(latest_.data()) + used_, utf8.size());  // may be empty
  used_ += utf8.size();
}

void CborWriter::whole(std::int64_t number) {
  if (number >= 0) {
    head(Major::Unsigned, static_cast<std::uint64_t>(number));
  } else {
    head(Major::Negative, static_cast<std::uint64_t>(-(number + 1)));
  }
}

void CborWriter::real(double number) {
  head(Major::Simple, 27, std::bit_cast<std::uint64_t>(number), sizeof number);
}

void CborWriter::truth(bool yes) {
  head(Major::Simple, yes ? 21 : 20);
}

void CborWriter::byte_string(const icd::ChunkedBytes& bytes) {
  head(Major::Bytes, bytes.size());
  flush();
  out_.append(bytes);
}

void CborWriter::flush() {
  out_.append(std::span(latest_).first(std::exchange(used_, 0)));
}

icd::ChunkedBytes CborWriter::finish() {
  flush();
  return std::move(out_);
}

}  // namespace adit::codec
