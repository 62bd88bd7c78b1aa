#include "archive/record.hpp"

#include <zlib.h>

#include "icd/require.hpp"

namespace adit::archive {
namespace {

constexpr std::string_view kBegins =
    "\xA7"
    "adr";
constexpr std::size_t kHead = 12;  // what begins it, length and checksum
/// Each that looks like one and is none costs a checksum.
constexpr int kMostDamaged = 4096;

void put(std::string& to, std::uint32_t number) {
  for (const int shift : {0, 8, 16, 24}) to += static_cast<char>(number >> shift & 0xff);
}

std::uint32_t number_at(std::string_view from, std::size_t at) {
  std::uint32_t number = 0;
  for (std::size_t i = 4; i-- > 0;) number = number << 8 | static_cast<unsigned char>(from[at + i]);
  return number;
}

std::uint32_t checksum_of(std::string_view body) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(body.data()), body.size()));
}

/// The kind and what is said of the record at the begin of `bytes`; empty where it is damaged.
std::string_view body_at_begin(std::string_view bytes) {
  if (bytes.size() <= kHead) return {};
  const std::uint32_t length = number_at(bytes, 4);
  if (length == 0 || length > kLargestRecord || length > bytes.size() - kHead) return {};
  const std::string_view body = bytes.substr(kHead, length);
  return checksum_of(body) == number_at(bytes, 8) ? body : std::string_view();
}

/// Whether the record at the begin of `bytes` is whole. A torn one is shorter than it says.
bool is_whole(std::string_view bytes) {
  if (bytes.size() <= kHead) return false;
  const std::size_t size = kHead + number_at(bytes, 4);
  return size == bytes.size() || (size < bytes.size() && bytes.substr(size).starts_with(kBegins));
}

}  // namespace

std::string framed(Kind kind, std::string_view said) {
  icd::require(said.size() < kLargestRecord);
  std::string body(1, static_cast<char>(kind));
  body += said;
  std::string record(kBegins);
  put(record, static_cast<std::uint32_t>(body.size()));
  put(record, checksum_of(body));
  return record += body;
}

std::size_t for_each_record(std::string_view bytes, const std::function<void(Kind, std::string_view)>& told) {
  std::size_t damaged = 0;
  for (int passed_over = 0; passed_over < kMostDamaged;) {
    const auto begin = bytes.find(kBegins);
    if (begin == std::string_view::npos) break;
    bytes.remove_prefix(begin);
    const std::string_view body = body_at_begin(bytes);
    if (body.empty()) {
      ++passed_over;
      if (is_whole(bytes)) ++damaged;
      bytes.remove_prefix(1);
      continue;
    }
    told(static_cast<Kind>(body.front()), body.substr(1));
    bytes.remove_prefix(kHead + body.size());
  }
  return damaged;
}

}  // namespace adit::archive
