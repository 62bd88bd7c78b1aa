#include "journal/record.hpp"

#include <zlib.h>

#include <array>
#include <bit>

namespace adit::journal {
namespace {

constexpr std::size_t kHead = 8;  // length and checksum

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

/// Of the length too: a length that is damaged must not pass for another record's end.
std::uint32_t checksum(std::string_view length, std::string_view body) {
  const auto add = [](std::uint32_t sum, std::string_view bytes) {
    return static_cast<std::uint32_t>(
        crc32_z(sum, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
  };
  return add(add(0, length), body);
}

/// Up to what it says, of so many bytes.
std::string begun(Kind kind, std::size_t size) {
  std::string record;
  record.reserve(kHead + 1 + size);
  put(record, size + 1, 4);
  put(record, 0, 4);
  return record += static_cast<char>(kind);
}

/// Writes its checksum.
void seal(std::string& record) {
  const std::string_view all = record;
  const std::uint32_t sum = checksum(all.substr(0, 4), all.substr(kHead));
  for (int i = 0; i < 4; ++i) record[4 + i] = static_cast<char>(sum >> (8 * i));
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

std::string framed(Kind kind, std::string_view said) {
  std::string record = begun(kind, said.size());
  record += said;
  seal(record);
  return record;
}

std::string framed(Kind kind, const icd::ChunkedBytes& said) {
  std::string record = begun(kind, said.size());
  for (const icd::Chunk& chunk : said.chunks())
    record.append(reinterpret_cast<const char*>(chunk->data()), chunk->size());
  seal(record);
  return record;
}

void for_each_record(std::string_view bytes, const std::function<bool(Kind, std::string_view)>& told) {
  while (bytes.size() > kHead) {
    const std::uint64_t length = get(bytes.substr(0, 4));
    if (length == 0 || length > bytes.size() - kHead) return;
    const std::string_view body = bytes.substr(kHead, length);
    if (get(bytes.substr(4, 4)) != checksum(bytes.substr(0, 4), body)) return;
    if (!told(static_cast<Kind>(body.front()), body.substr(1))) return;
    bytes.remove_prefix(kHead + length);
  }
}

}  // namespace adit::journal
