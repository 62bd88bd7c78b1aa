#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace adit::pack {

/// How far bytes go on as they were `distance` bytes before, asked from one place after the other.
///
/// It compares 64 bytes at a time and keeps what it saw as bits, so that no byte is compared twice.
class SameAsBefore {
 public:
  /// Of `bytes`, of which those from `first` on are there. From where it is asked, 64 bytes more than there
  /// are can be read, whatever they hold.
  SameAsBefore(const std::uint8_t* bytes, std::size_t first, std::size_t distance)
      : bytes_(bytes), first_(first), distance_(distance) {}

  /// Where the first byte is from `place` on that differs from the one before; `end` or beyond if none does.
  std::size_t until(std::size_t place, std::size_t end) {
    if (place < until_) return until_;
    std::size_t word = place / kWord;
    if (word != word_) look_at(word);
    const std::uint64_t others = others_ >> place % kWord;
    if (others != 0) return until_ = place + static_cast<std::size_t>(std::countr_zero(others));
    do {
      if (++word * kWord >= end) return until_ = end;
      look_at(word);
    } while (others_ == 0);
    return until_ = word * kWord + static_cast<std::size_t>(std::countr_zero(others_));
  }

 private:
  static constexpr std::size_t kWord = 64;

  void look_at(std::size_t word) {
    word_ = word;
    const std::size_t place = word * kWord;
    others_ = place >= first_ + distance_ ? compared(place) : compared_singly(place);
  }

  /// A bit for each byte that differs.
  std::uint64_t compared(std::size_t place) const {
    std::uint64_t now[8], before[8], any = 0;
    std::memcpy(now, bytes_ + place, sizeof now);
    std::memcpy(before, bytes_ + place - distance_, sizeof before);
    for (int i = 0; i < 8; ++i) any |= now[i] ^= before[i];
    if (any == 0) return 0;
    std::uint64_t bits = 0;
    for (unsigned i = 0; i < 8; ++i) bits |= nonzero_bytes(now[i]) << 8 * i;
    return bits;
  }

  static std::uint64_t nonzero_bytes(std::uint64_t eight) {
    constexpr std::uint64_t kLow = 0x7f7f7f7f7f7f7f7f, kOnes = 0x0101010101010101,
                            kGather = 0x0102040810204080;
    const std::uint64_t ones = (((eight & kLow) + kLow) | eight) >> 7 & kOnes;
    return ones * kGather >> 56;
  }

  /// Where some have nothing before them.
  std::uint64_t compared_singly(std::size_t place) const {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < kWord; ++i) {
      const std::size_t each = place + i;
      const bool is_same = each >= first_ + distance_ && bytes_[each] == bytes_[each - distance_];
      bits |= std::uint64_t{!is_same} << i;
    }
    return bits;
  }

  const std::uint8_t* bytes_;
  std::size_t first_, distance_;
  std::size_t word_ = SIZE_MAX, until_ = 0;
  std::uint64_t others_ = 0;
};

}  // namespace adit::pack
