#include "store/values.hpp"

#include <bit>

#include "store/frame.hpp"

namespace adit::store {

void Writer::operator()(std::uint64_t number) {
  put_number(bytes_, number, 8);
}

void Writer::operator()(double real) {
  (*this)(std::bit_cast<std::uint64_t>(real));
}

void Writer::operator()(std::string_view text) {
  (*this)(text.size());
  bytes_ += text;
}

std::string_view Reader::take(std::size_t size) {
  check(size <= left_.size());
  if (!ok_) return {};
  const std::string_view taken = left_.substr(0, size);
  left_.remove_prefix(size);
  return taken;
}

std::uint64_t Reader::number() {
  const std::string_view bytes = take(8);
  return bytes.empty() ? 0 : number_at(bytes, 0, 8);
}

void Reader::operator()(double& real) {
  real = std::bit_cast<double>(number());
}

}  // namespace adit::store
