#include "archive/record.hpp"

#include <zlib.h>

#include "icd/require.hpp"
#include "store/frame.hpp"

namespace adit::archive {
namespace {

using store::number_at, store::put_number;

constexpr std::string_view kBegins =
    "\xA7"
    "adr";
constexpr std::size_t kHead = 12;  // marker, length and checksum
/// Limits the checksums spent on bytes that only look like a record.
constexpr int kMostDamaged = 4096;

std::uint32_t checksum_of(std::string_view body) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(body.data()), body.size()));
}

/// The body of the first record in `bytes`; empty if damaged.
std::string_view body_at_begin(std::string_view bytes) {
  if (bytes.size() <= kHead) return {};
  const std::uint64_t length = number_at(bytes, 4, 4);
  if (length == 0 || length > kLargestRecord || length > bytes.size() - kHead) return {};
  const std::string_view body = bytes.substr(kHead, length);
  return checksum_of(body) == number_at(bytes, 8, 4) ? body : std::string_view();
}

/// Whether the first record has its full length. A torn record is shorter.
bool is_whole(std::string_view bytes) {
  if (bytes.size() <= kHead) return false;
  const std::size_t size = kHead + number_at(bytes, 4, 4);
  return size == bytes.size() || (size < bytes.size() && bytes.substr(size).starts_with(kBegins));
}

}  // namespace

std::string framed(std::string_view said) {
  icd::require(!said.empty() && said.size() <= kLargestRecord);
  std::string record(kBegins);
  put_number(record, said.size(), 4);
  put_number(record, checksum_of(said), 4);
  return record.append(said);
}

std::size_t for_each_record(std::string_view bytes, const std::function<void(std::string_view)>& told) {
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
    told(body);
    bytes.remove_prefix(kHead + body.size());
  }
  return damaged;
}

}  // namespace adit::archive
