#include "api/bundle.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>

#include "codec/gzip.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"

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

constexpr std::size_t kPerFile = 2048;  // tar's header and padding, and a share of the ends of gzip and tar

std::size_t size_of(const std::vector<BundleFile>& files) {
  return std::accumulate(files.begin(), files.end(), std::size_t{0},
                         [](std::size_t sum, const BundleFile& file) { return sum + file.body.size(); });
}

/// Limit for each body, so that all together have at most `most` bytes.
std::size_t longest_allowed(const std::vector<BundleFile>& files, std::size_t most) {
  std::vector<std::size_t> sizes;
  sizes.reserve(files.size());
  for (const BundleFile& file : files) sizes.push_back(file.body.size());
  std::ranges::sort(sizes);
  std::size_t left = most;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::size_t share = left / (sizes.size() - i);
    if (sizes[i] > share) return share;  // this one and all larger ones
    left -= sizes[i];
  }
  return most;
}

void cut(std::string& body, std::size_t longest) {
  const std::size_t length = body.size();
  const auto line = [length](std::size_t gone) {
    return icd::sentence("[the first ", gone, " of ", length,
                         " bytes are cut off: the bundle would be too large]\n");
  };
  const std::size_t words = line(length).size();
  std::size_t begin = length - (longest > words ? longest - words : 0);
  while (begin < length && !icd::begins_character(body[begin])) ++begin;
  body = line(begin) + body.substr(begin);
}

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

void cut_to(std::vector<BundleFile>& files, std::size_t most) {
  if (size_of(files) <= most) return;
  const std::size_t longest = longest_allowed(files, most);
  for (BundleFile& file : files) {
    if (file.body.size() > longest) cut(file.body, longest);
  }
}

std::string write_bundle(std::vector<BundleFile> files, const std::string& folder, Time now) {
  cut_to(files, kMostBundle - kPerFile * (files.size() + 1));
  Ustar archive;
  for (const BundleFile& file : files) {
    archive.add(folder + "/" + file.name, file.body, static_cast<std::int64_t>(now));
  }
  return codec::gzip(archive.finish(), codec::GzipStrategy::Default).to_string();
}

}  // namespace adit::api
