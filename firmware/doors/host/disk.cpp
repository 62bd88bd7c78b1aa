#include "host/disk.hpp"

#include <sys/stat.h>
#include <sys/statvfs.h>
#include <sys/sysmacros.h>

#include <algorithm>
#include <cerrno>
#include <sstream>

#include "host/files.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::host {
namespace {

/// The highest of `count` hexadecimal numbers in a file; 0 if the file is absent.
std::expected<unsigned, std::string> highest_in(const std::string& path, int count, unsigned most) {
  const auto file = slurp(path);
  if (!file && file.error() == ENOENT) return 0;
  if (!file) return std::unexpected(path_error(path, file.error()));
  std::istringstream numbers(file->text);
  unsigned highest = 0;
  for (unsigned number = 0; count > 0; --count) {
    numbers >> std::hex >> number;
    highest = std::max(highest, number);
  }
  if (numbers && (numbers >> std::ws).eof() && highest <= most) return highest;
  return std::unexpected(path + ": unknown value " + icd::quote_text(file->text));
}

}  // namespace

std::optional<Disk> disk_of(const std::string& folder) {
  struct statvfs disk{};
  if (statvfs(folder.c_str(), &disk) != 0) return std::nullopt;
  return Disk{std::uint64_t{disk.f_blocks} * disk.f_frsize, std::uint64_t{disk.f_bavail} * disk.f_frsize};
}

std::expected<Wear, std::string> read_wear(const std::string& folder, const std::string& block) {
  struct stat status{};
  if (stat(folder.c_str(), &status) != 0) return std::unexpected(path_error(folder, errno));
  std::string disk = icd::sentence(block, "/", major(status.st_dev), ":", minor(status.st_dev));
  if (can_exist(disk + "/partition")) disk += "/..";
  const auto life = ADIT_TRY(highest_in(disk + "/device/life_time", 2, 0x0b));
  const auto spares = ADIT_TRY(highest_in(disk + "/device/pre_eol_info", 1, 0x03));
  return Wear{life, spares};
}

}  // namespace adit::host
