#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>

namespace adit::host {

/// The file system of a directory, in bytes.
struct Disk {
  std::uint64_t all = 0, free = 0;  // `free`: for this user
};
/// std::nullopt with errno: unknown.
std::optional<Disk> disk_of(const std::string& folder);

/// An eMMC's wear (JESD84-B50 7.4: DEVICE_LIFE_TIME_EST_TYP_A and _B, PRE_EOL_INFO). 0: not reported.
struct Wear {
  unsigned life = 0;    // the higher estimate: 1 is up to 10 % of its life, 10 is 90 to 100 %, 11 is more
  unsigned spares = 0;  // use of its spare blocks: 1 is normal, 2 is 80 %, 3 is urgent
};
/// The wear of a directory's disk, as the kernel read it at the boot. `block`: the kernel's directory of
/// block devices by number. Cards and virtual disks report no wear. An error names the file: the wear is
/// unknown.
std::expected<Wear, std::string> read_wear(const std::string& folder, const std::string& block);

}  // namespace adit::host
