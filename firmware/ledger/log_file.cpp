#include "ledger/log_file.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ledger/big_endian.hpp"

namespace adit::ledger {
namespace {

/// https://www.sqlite.org/fileformat2.html#walformat
constexpr std::uint32_t kMagic = 0x377f0682;  // of a log whose checksums have little-endian words
constexpr std::uint32_t kFormat = 3007000;
constexpr std::size_t kMagicAt = 0, kFormatAt = 4, kPageSizeAt = 8, kLogSaltAt = 16, kLogSumAt = 24;
constexpr std::size_t kCommitAt = 4, kSaltAt = 8, kSumAt = 16;
constexpr std::size_t kSummed = 8;  // bytes of a frame's header that its checksum is of

struct Sum {
  std::uint32_t first = 0, second = 0;
  friend bool operator==(const Sum&, const Sum&) = default;
};

std::uint32_t big_endian_at(const char* at) {
  return static_cast<std::uint32_t>(big_endian({at, 4}));
}

void put_big_endian(char* at, std::uint32_t value) {
  for (int i = 3; i >= 0; --i, value >>= 8) at[i] = static_cast<char>(value);
}

Sum stored_sum(const char* at) {
  return {big_endian_at(at), big_endian_at(at + 4)};
}

/// The words of a checksum are in the byte order of the machine that wrote the log: this one.
static_assert(std::endian::native == std::endian::little);

std::uint32_t word_at(const char* at) {
  std::uint32_t word = 0;
  std::memcpy(&word, at, sizeof word);
  return word;
}

Sum sum_on(Sum sum, const char* at, std::size_t size) {
  for (std::size_t i = 0; i < size; i += 8) {
    sum.first += word_at(at + i) + sum.second;
    sum.second += word_at(at + i + 4) + sum.first;
  }
  return sum;
}

Sum sum_of_frame(Sum before, const char* frame) {
  return sum_on(sum_on(before, frame, kSummed), frame + kFrameHeader, kPage);
}

/// How many of four bytes differ.
int bytes_apart(std::uint32_t one, std::uint32_t other) {
  int apart = 0;
  for (std::uint32_t both = one ^ other; both != 0; both >>= 8) apart += (both & 0xff) != 0 ? 1 : 0;
  return apart;
}

/// x with odd * x = 1, by Newton's steps.
std::uint32_t inverse(std::uint32_t odd) {
  std::uint32_t found = odd;
  for (int i = 0; i < 5; ++i) found *= 2 - odd * found;
  return found;
}

/// What one byte of a word that lay `after` pairs before the end must have become, so that the checksum is
/// off by `off`: by how much the word is. A checksum is a sum of its words, each times a number that its
/// place gives, of which one of the two is odd.
std::optional<std::uint32_t> shift_of_word(Sum off, Sum weight) {
  const std::uint32_t shift =
      weight.first % 2 == 1 ? off.first * inverse(weight.first) : off.second * inverse(weight.second);
  if (shift * weight.first != off.first || shift * weight.second != off.second) return std::nullopt;
  return shift;
}

class Reader {
 public:
  explicit Reader(std::string& log) : log_(log) {}

  LogReading read() {
    reading_.empty = std::ranges::all_of(log_, [](char byte) { return byte == 0; });
    if (reading_.empty) return reading_;
    if (!read_header()) {
      reading_.damage = "its header is damaged";
      return reading_;
    }
    std::size_t at = kLogHeader;
    while (has_frame(at) && is_next(at)) at += kFrame;
    look_behind(at);
    return reading_;
  }

 private:
  bool has_frame(std::size_t at) const { return at + kFrame <= log_.size(); }
  const char* frame(std::size_t at) const { return log_.data() + at; }
  bool has_salt(std::size_t at) const {
    return std::equal(frame(at) + kSaltAt, frame(at) + kSaltAt + 8, log_.data() + kLogSaltAt);
  }

  void repair(std::size_t at, std::span<const char> bytes) {
    for (std::size_t i = 0; i < bytes.size(); ++i) {
      if (log_[at + i] == bytes[i]) continue;
      log_[at + i] = bytes[i];
      reading_.repairs.push_back({at + i, bytes[i]});
    }
  }

  bool header_is_right() const {
    return big_endian_at(log_.data() + kMagicAt) == kMagic &&
           big_endian_at(log_.data() + kFormatAt) == kFormat &&
           big_endian_at(log_.data() + kPageSizeAt) == kPage &&
           sum_on({}, log_.data(), kLogSumAt) == stored_sum(log_.data() + kLogSumAt);
  }

  /// As it is, or with one byte put right. Its last salt and its checksum may each be what explains the
  /// other: the frames tell which salt it is.
  bool read_header() {
    if (log_.size() < kLogHeader) return false;
    const bool followed = has_frame(kLogHeader);
    if (!header_is_right() && !(followed && repair_header(true)) && !repair_header(false)) return false;
    sum_ = stored_sum(log_.data() + kLogSumAt);
    return true;
  }

  /// `by_frame`: so that its salt is that of the first frame.
  bool repair_header(bool by_frame) {
    for (std::size_t at = 0; at < kLogHeader; ++at) {
      const char was = log_[at];
      for (int byte = 0; byte < 256; ++byte) {
        log_[at] = static_cast<char>(byte);
        if (!header_is_right() || (by_frame && !has_salt(kLogHeader))) continue;
        reading_.repairs.push_back({at, log_[at]});
        return true;
      }
      log_[at] = was;
    }
    return false;
  }

  /// Whether the frame goes on from the one before, as it is or once it is put right.
  bool is_next(std::size_t at) {
    const Sum right = sum_of_frame(sum_, frame(at));
    const Sum stored = stored_sum(frame(at) + kSumAt);
    const bool salt = has_salt(at);
    if (right == stored) {
      if (!salt) repair(at + kSaltAt, std::span(log_).subspan(kLogSaltAt, 8));
      sum_ = right;
      return true;
    }
    if (!salt || !put_right(at, right, stored)) return false;
    sum_ = sum_of_frame(sum_, frame(at));
    return true;
  }

  bool put_right(std::size_t at, Sum right, Sum stored) {
    const bool followed = has_frame(at + kFrame) && has_salt(at + kFrame);
    const char* const next = frame(at + kFrame);
    const auto goes_on = [&](Sum sum) {
      return !followed || sum_of_frame(sum, next) == stored_sum(next + kSumAt);
    };
    const bool sum_is_bad =
        bytes_apart(right.first, stored.first) + bytes_apart(right.second, stored.second) == 1;
    const Sum off{stored.first - right.first, stored.second - right.second};
    if (sum_is_bad && !followed && !words_that_explain(at, off).empty()) {
      reading_.damage = damage_of(at);  // it is either's
      return false;
    }
    if (sum_is_bad && goes_on(right)) {
      std::array<char, 8> bytes{};
      put_big_endian(bytes.data(), right.first);
      put_big_endian(bytes.data() + 4, right.second);
      repair(at + kSumAt, bytes);
      return true;
    }
    return put_word_right(at, off);
  }

  /// Where there is one word that explains it. Of a word's highest bit many do: then none is known to be it,
  /// and that the frame is damaged is certain.
  bool put_word_right(std::size_t at, Sum off) {
    const std::vector<Word> found = words_that_explain(at, off);
    if (found.size() > 1) reading_.damage = damage_of(at);
    if (found.size() != 1) return false;
    std::array<char, 4> bytes{};
    std::memcpy(bytes.data(), &found[0].right, bytes.size());
    repair(found[0].place, bytes);
    return true;
  }

  struct Word {
    std::size_t place;
    std::uint32_t right;
  };
  std::vector<Word> words_that_explain(std::size_t at, Sum off) const {
    std::vector<Word> found;
    Sum even{1, 1}, odd{0, 1};  // the weights of a pair's two words
    for (std::size_t pair = (kSummed + kPage) / 8; pair-- > 0;) {
      const std::size_t first = at + (pair == 0 ? 0 : kFrameHeader - kSummed) + pair * 8;
      for (const auto& [place, weight] : {std::pair{first, even}, std::pair{first + 4, odd}}) {
        if (const auto right = word_that_explains(place, off, weight)) found.push_back({place, *right});
      }
      for (Sum* const weight : {&even, &odd}) {
        *weight = {weight->first + weight->second, weight->first + 2 * weight->second};
      }
    }
    return found;
  }

  std::optional<std::uint32_t> word_that_explains(std::size_t place, Sum off, Sum weight) const {
    const auto shift = shift_of_word(off, weight);
    if (!shift) return std::nullopt;
    const std::uint32_t word = word_at(log_.data() + place);
    if (bytes_apart(word, word + *shift) != 1) return std::nullopt;
    return word + *shift;
  }

  /// What lies behind the last frame that is right: nothing of this round, or what a power cut or damage
  /// left.
  void look_behind(std::size_t at) {
    reading_.ended = at + kFrameHeader <= log_.size() && !has_salt(at);
    int whole = 0;  // transactions whose end is right, behind what is not
    for (std::size_t next = at; has_frame(next + kFrame); next += kFrame) {
      const std::size_t behind = next + kFrame;
      if (!has_salt(behind)) continue;
      const char* const bytes = frame(behind);
      const bool goes_on =
          sum_of_frame(stored_sum(frame(next) + kSumAt), bytes) == stored_sum(bytes + kSumAt);
      if (goes_on && big_endian_at(bytes + kCommitAt) != 0) ++whole;
    }
    // One more was perhaps under way, while the flush of the one before was left for later.
    if (whole > 1) reading_.damage = damage_of(at);
  }

  static std::string damage_of(std::size_t at) {
    return "frame " + std::to_string((at - kLogHeader) / kFrame + 1) + " is damaged";
  }

  std::string& log_;
  LogReading reading_;
  Sum sum_;
};

}  // namespace

LogReading read_log(std::string& log) {
  return Reader(log).read();
}

}  // namespace adit::ledger
