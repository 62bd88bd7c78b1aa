#include "api/bundle.hpp"

#include <algorithm>
#include <numeric>

#include "api/ustar.hpp"
#include "codec/gzip.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

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

bool begins_a_character(char byte) {
  return (static_cast<unsigned char>(byte) & 0xc0) != 0x80;  // UTF-8
}

void cut(std::string& body, std::size_t longest) {
  const std::size_t length = body.size();
  const auto line = [length](std::size_t gone) {
    return icd::sentence("[the first ", gone, " of ", length,
                         " bytes are cut off: the bundle would be too large]\n");
  };
  const std::size_t words = line(length).size();
  std::size_t begin = length - (longest > words ? longest - words : 0);
  while (begin < length && !begins_a_character(body[begin])) ++begin;
  body = line(begin) + body.substr(begin);
}

}  // namespace

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
