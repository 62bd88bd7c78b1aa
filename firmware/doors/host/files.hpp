#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <expected>
#include <string>

namespace adit::host {

inline constexpr std::size_t kLargestFile = 1u << 20;

struct File {
  std::string text;
  struct stat status;  // of the file that was read
};

/// The text, or errno; EFBIG above `most` bytes.
std::expected<File, int> slurp(const std::string& path, std::size_t most = kLargestFile);
/// The text without the last line of write_kept(), if its checksum is right.
std::string without_checksum(std::string text);

/// Syncs the directory of this file, so that the file's name survives a power cut. False: see errno.
bool sync_folder(const std::string& path);

/// "PATH: No such file or directory"
std::string trouble(const std::string& path, int error);

}  // namespace adit::host
