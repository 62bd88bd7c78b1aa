#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace adit::host {

/// The file system that a folder is on, in bytes.
struct Disk {
  std::uint64_t all = 0, free = 0;  // `free`: for this user
};
/// Nothing, with errno: it cannot be asked.
std::optional<Disk> disk_of(const std::string& folder);

}  // namespace adit::host
