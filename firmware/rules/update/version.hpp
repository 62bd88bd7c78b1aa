#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::update {

/// A version of Semantic Versioning 2.0: "0.2.0", "1.0.0-rc.1", "1.0.0+a1b2c3". Ordered by clause 11: numbers
/// by value, a pre-release before its release, build metadata ignored.
class Version {
 public:
  static constexpr std::size_t kLongest = 64;

  /// std::nullopt if the text is not a version.
  static std::optional<Version> parse(std::string_view text);

  friend std::strong_ordering operator<=>(const Version& left, const Version& right);
  friend bool operator==(const Version& left, const Version& right) { return (left <=> right) == 0; }

 private:
  std::vector<std::uint64_t> release_;    // major, minor, patch
  std::vector<std::string> pre_release_;  // empty for a release
};

}  // namespace adit::update
