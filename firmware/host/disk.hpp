#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace adit::host {

/// The file system of a directory, in bytes.
struct Disk {
  std::uint64_t all = 0, free = 0;  // `free`: for this user
};
/// std::nullopt with errno: unknown.
std::optional<Disk> disk_of(const std::string& folder);

}  // namespace adit::host
