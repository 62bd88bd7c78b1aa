#include "host/disk.hpp"

#include <sys/statvfs.h>

namespace adit::host {

std::optional<Disk> disk_of(const std::string& folder) {
  struct statvfs disk{};
  if (statvfs(folder.c_str(), &disk) != 0) return std::nullopt;
  return Disk{std::uint64_t{disk.f_blocks} * disk.f_frsize, std::uint64_t{disk.f_bavail} * disk.f_frsize};
}

}  // namespace adit::host
