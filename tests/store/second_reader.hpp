#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace adit::store {

/// A log as firmware/doors/store/README.md describes it, read by other means than the firmware's: every
/// multiple of 8 bytes of every file is tried, with a checksum of its own, and the answer is a set, not a
/// walk.
struct SecondReading {
  std::vector<std::string> snapshot;             // bodies, of the newest whole one
  std::map<std::uint64_t, std::string> records;  // by sequence number
  std::set<std::uint64_t> missing;
  /// All bodies, in order.
  std::vector<std::string> bodies() const;
};
SecondReading read_again(const std::map<std::string, std::string>& files);

}  // namespace adit::store
