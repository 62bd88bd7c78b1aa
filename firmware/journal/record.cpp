#include "journal/record.hpp"

#include <array>
#include <bit>

namespace adit::journal {
namespace {

void put(std::string& to, std::uint64_t number, int bytes) {
  std::array<char, 8> little{};
  for (int i = 0; i < bytes; ++i)
    little.at(static_cast<std::size_t>(i)) = static_cast<char>(number >> (8 * i));
  to.append(little.data(), static_cast<std::size_t>(bytes));
}

std::uint64_t get(std::string_view from) {
  std::uint64_t number = 0;
  for (std::size_t i = from.size(); i-- > 0;) number = number << 8 | static_cast<unsigned char>(from[i]);
  return number;
}

}  // namespace

Writer& Writer::number(std::uint64_t number) {
  put(bytes_, number, 8);
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
  return get(take(8));
}

double Reader::real() {
  return std::bit_cast<double>(number());
}

std::string_view Reader::text() {
  return take(number());
}

}  // namespace adit::journal
