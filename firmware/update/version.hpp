#pragma once

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::update {

/// A version as Semantic Versioning 2.0 has it: "0.2.0", "1.0.0-rc.1", "1.0.0+a1b2c3". Ordered by its clause
/// 11: numbers as numbers, a pre-release before its release, and what stands after a + counts for nothing.
class Version {
 public:
  static constexpr std::size_t kLongest = 64;

  /// Nothing where the text is none.
  static std::optional<Version> parse(std::string_view text);

  friend std::strong_ordering operator<=>(const Version& left, const Version& right);
  friend bool operator==(const Version& left, const Version& right) { return (left <=> right) == 0; }

 private:
  std::vector<std::uint64_t> release_;    // major, minor, patch
  std::vector<std::string> pre_release_;  // none: it is a release
};

}  // namespace adit::update
