#include "host/disk.hpp"

#include <sys/statvfs.h>

namespace adit::host {

std::optional<std::uint64_t> free_bytes(const std::string& folder) {
  struct statvfs disk{};
  if (statvfs(folder.c_str(), &disk) != 0) return std::nullopt;
  return std::uint64_t{disk.f_bavail} * disk.f_frsize;
}

}  // namespace adit::host
