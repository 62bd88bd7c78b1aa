#include "archive/framed_records.hpp"

#include "icd/require.hpp"
#include "store/frame.hpp"

namespace adit::archive {
namespace {

/// A frame may begin anywhere, and is valid at any place of any file.
constexpr store::Layout kPacked{.align = 1, .copies = 1};
constexpr std::uint64_t kSalt = 0;
constexpr std::size_t kPlace = 0;
/// Limits the checksums spent on bytes that only look like a record.
constexpr int kMostDamaged = 4096;

std::size_t size_of(std::string_view bytes) {
  return store::room_of(store::number_at(bytes, 8, 4), kPacked);
}

/// The body of the first record in `bytes`; empty if damaged.
std::string_view body_at_begin(std::string_view bytes) {
  if (size_of(bytes) > store::room_of(kLargestRecord, kPacked)) return {};
  const auto parsed = store::parse(bytes, kPlace, kSalt);
  return parsed ? parsed->frame.body : std::string_view();
}

/// Whether the first record has its full length. A torn record is shorter.
bool is_whole(std::string_view bytes) {
  const std::size_t size = size_of(bytes), head = store::room_of(0, kPacked);
  return size == bytes.size() ||
         (size < bytes.size() && store::next_candidate(bytes.substr(size, head), 0, kPacked) == 0);
}

}  // namespace

std::string framed(std::string_view body) {
  icd::require(!body.empty() && body.size() <= kLargestRecord);
  return store::written({.body = body}, kPacked, kSalt, kPlace);
}

std::size_t for_each_record(std::string_view bytes, const std::function<void(std::string_view)>& told) {
  std::size_t damaged = 0;
  for (int passed_over = 0; passed_over < kMostDamaged;) {
    bytes.remove_prefix(store::next_candidate(bytes, 0, kPacked));
    if (bytes.empty()) break;
    const std::string_view body = body_at_begin(bytes);
    if (body.empty()) {
      ++passed_over;
      if (is_whole(bytes)) ++damaged;
      bytes.remove_prefix(1);
      continue;
    }
    told(body);
    bytes.remove_prefix(size_of(bytes));
  }
  return damaged;
}

}  // namespace adit::archive
