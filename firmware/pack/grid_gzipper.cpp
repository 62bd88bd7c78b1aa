#include "pack/grid_gzipper.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>

namespace adit::pack {
namespace {

constexpr std::size_t kAtOnce = std::size_t{128} * 1024;
constexpr std::size_t kReadBeyond = 64;  // by SameAsBefore
/// A block has about so many tokens: fewer, and the codes' own bytes count; more, and the codes fit less.
constexpr std::size_t kBlockTokens = 10'000;
/// Costs follow what was found in the block so far, at first soon.
constexpr std::size_t kLearnFirst = 256, kLearnEvery = 2048;

std::vector<std::size_t> distances_for(std::size_t width) {
  std::vector<std::size_t> distances{1};
  for (const std::size_t distance : {width, width + 1, width - 1}) {
    if (distance > 1 && distance <= kMostDistance) distances.push_back(distance);
  }
  return distances;
}

}  // namespace

GridGzipper::GridGzipper(std::size_t width)
    : cells_(kMostDistance + kAtOnce + kReadBeyond),
      first_(kMostDistance),
      next_(kMostDistance),
      end_(kMostDistance),
      cheapest_(distances_for(width)) {
  constexpr std::array<std::uint8_t, 10> kHead{0x1f, 0x8b, 8, 0, 0, 0, 0, 0, 0, 255};  // RFC 1952 2.3
  for (const std::uint8_t byte : kHead) out_.put(byte, 8);
}

void GridGzipper::feed(std::span<const std::uint8_t> cells) {
  crc_ = libdeflate_crc32(crc_, cells.data(), cells.size());
  size_ += static_cast<std::uint32_t>(cells.size());  // modulo 2^32, as ISIZE is
  while (!cells.empty()) {
    if (end_ == kMostDistance + kAtOnce) make_room();
    const auto part = cells.first(std::min(cells.size(), kMostDistance + kAtOnce - end_));
    std::ranges::copy(part, cells_.begin() + static_cast<std::ptrdiff_t>(end_));
    end_ += part.size();
    cells = cells.subspan(part.size());
  }
}

/// Only what copies can reach stays, and what has no token yet.
void GridGzipper::make_room() {
  encode(false);
  const std::size_t gone = next_ - kMostDistance;
  std::copy(cells_.begin() + static_cast<std::ptrdiff_t>(gone),
            cells_.begin() + static_cast<std::ptrdiff_t>(end_), cells_.begin());
  first_ -= std::min(first_, gone);
  next_ -= gone;
  end_ -= gone;
}

void GridGzipper::encode(bool to_the_end) {
  const std::size_t kept_back = to_the_end ? 0 : kMostCopy;  // so that a copy does not end where a piece does
  while (next_ + kept_back < end_) {
    const std::size_t end = std::min(end_ - kept_back, next_ + CheapestTokens::kMostCells);
    next_ = cheapest_.find({cells_.data(), first_, end_}, next_, end, costs_, tokens_);
    learn();
    if (tokens_.size() < kBlockTokens || (to_the_end && next_ == end_)) continue;
    end_block(false);
  }
}

void GridGzipper::end_block(bool is_last) {
  counts_.add(std::span(tokens_).subspan(learned_));
  write_block(out_, tokens_, counts_, is_last);
  tokens_.clear();
  learned_ = 0;
  counts_ = {};
}

void GridGzipper::learn() {
  const std::size_t fresh = tokens_.size() - learned_;
  if (fresh < (learned_ == 0 ? kLearnFirst : kLearnEvery)) return;
  counts_.add(std::span(tokens_).subspan(learned_));
  learned_ = tokens_.size();
  costs_ = TokenCosts(lengths_for(counts_));
}

icd::ChunkedBytes GridGzipper::finish() {
  encode(true);
  end_block(true);
  out_.finish();
  for (const std::uint32_t number : {crc_, size_}) out_.put(number, 32);
  out_.finish();
  return std::move(member_);
}

}  // namespace adit::pack
