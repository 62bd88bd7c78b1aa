#include "api/ustar.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace adit::api {
namespace {

constexpr std::size_t kBlock = 512;

/// A file's header block with fields at fixed places (POSIX.1-1988 10.1.1).
class Header {
 public:
  void text(std::size_t at, std::string_view text) { std::ranges::copy(text, block_.begin() + at); }

  /// `digits` octal digits before the existing zero byte.
  void octal(std::size_t at, std::size_t digits, std::uint64_t number) {
    for (std::size_t i = digits; i > 0; --i, number /= 8) {
      block_[at + i - 1] = static_cast<char>('0' + number % 8);
    }
  }

  std::string_view finish() {
    std::ranges::fill_n(block_.begin() + kSum, 8, ' ');  // the checksum counts its own field as spaces
    std::uint64_t sum = 0;
    for (const char byte : block_) sum += static_cast<std::uint8_t>(byte);
    block_[kSum + 6] = '\0';
    octal(kSum, 6, sum);
    return {block_.data(), block_.size()};
  }

 private:
  static constexpr std::size_t kSum = 148;
  std::array<char, kBlock> block_{};
};

}  // namespace

void Ustar::append(std::string_view bytes) {
  archive_.append(std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()));
}

void Ustar::add(std::string_view name, std::string_view body, std::int64_t modified) {
  Header header;
  header.text(0, name.substr(0, kLongestName));
  header.octal(100, 7, 0600);
  header.octal(108, 7, 0);
  header.octal(116, 7, 0);
  header.octal(124, 11, body.size());
  header.octal(136, 11, static_cast<std::uint64_t>(std::max<std::int64_t>(modified, 0)));
  header.text(156, "0");
  header.text(257, "ustar");
  header.text(263, "00");
  append(header.finish());
  append(body);
  append(std::string((kBlock - body.size() % kBlock) % kBlock, '\0'));
}

icd::ChunkedBytes Ustar::finish() {
  append(std::string(2 * kBlock, '\0'));
  return std::exchange(archive_, {});
}

}  // namespace adit::api
