#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace adit::store {

/// Reads a log as firmware/doors/store/README.md describes it, in another way than the firmware: tries
/// every multiple of 8 bytes of every file, with its own checksum, and returns a set.
struct SecondReading {
  std::vector<std::string> snapshot;             // bodies of the newest complete one
  std::map<std::uint64_t, std::string> records;  // by sequence number
  std::set<std::uint64_t> missing;
  std::uint64_t last = 0;  // sequence number of the last record, also of one that is only in the snapshot
  /// All bodies, in order.
  std::vector<std::string> bodies() const;
};
SecondReading read_again(const std::map<std::string, std::string>& files);

}  // namespace adit::store
