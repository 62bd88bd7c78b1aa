#include "picture/history.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "icd/require.hpp"

namespace adit::picture {
namespace {

bool in_one_span(double a, double b, double spacing) {
  return std::floor(a / spacing) == std::floor(b / spacing);
}

}  // namespace

std::size_t cost_of(const Version& version) {
  constexpr std::size_t kAllocation = 32;  // overhead of an allocation
  const std::size_t own = sizeof(Version) + kAllocation;
  return version.tile ? own + sizeof(Packed) + kAllocation + version.tile->deflated.size() : own;
}

void History::add(Version version, double spacing) {
  icd::require(versions_.empty() || version.stamp >= newest().stamp);
  if (!versions_.empty() && in_one_span(newest().stamp, version.stamp, spacing)) {
    cost_ -= cost_of(newest());
    versions_.pop_back();
  }
  cost_ += cost_of(version);
  versions_.push_back(std::move(version));
}

void History::thin(double spacing) {
  std::vector<Version> all;
  all.swap(versions_);
  cost_ = 0;
  for (Version& version : all) add(std::move(version), spacing);
  versions_.shrink_to_fit();
}

const Version* History::at(double stamp) const {
  const auto after = std::ranges::upper_bound(versions_, stamp, {}, &Version::stamp);
  return after == versions_.begin() ? nullptr : &*(after - 1);
}

std::optional<double> History::end_of(const Version& version) const {
  const auto after = std::ranges::upper_bound(versions_, version.stamp, {}, &Version::stamp);
  return after == versions_.end() ? std::nullopt : std::optional(after->stamp);
}

}  // namespace adit::picture
