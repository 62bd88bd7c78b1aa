#include "store/values.hpp"

#include <bit>

#include "store/frame.hpp"

namespace adit::store {

Writer& Writer::number(std::uint64_t number) {
  put_number(bytes_, number, 8);
  return *this;
}

Writer& Writer::real(double real) {
  return number(std::bit_cast<std::uint64_t>(real));
}

Writer& Writer::text(std::string_view text) {
  number(text.size());
  bytes_ += text;
  return *this;
}

std::string_view Reader::take(std::size_t size) {
  ok_ = ok_ && size <= left_.size();
  if (!ok_) return {};
  const std::string_view taken = left_.substr(0, size);
  left_.remove_prefix(size);
  return taken;
}

std::uint64_t Reader::number() {
  const std::string_view bytes = take(8);
  return bytes.empty() ? 0 : number_at(bytes, 0, 8);
}

double Reader::real() {
  return std::bit_cast<double>(number());
}

std::string_view Reader::text() {
  return take(number());
}

}  // namespace adit::store
