#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <expected>
#include <string>

namespace adit::host {

inline constexpr std::size_t kLargestFile = 1u << 20;

struct File {
  std::string text;
  struct stat status;  // of the very file that was read
};

/// The text, or the errno; EFBIG above `most` bytes.
std::expected<File, int> slurp(const std::string& path, std::size_t most = kLargestFile);
/// A file's text without the line of write_kept(), if that has the right checksum.
std::string without_checksum(std::string text);

/// Syncs the folder that has this file: only then its name outlives a power cut. False, with errno.
bool sync_folder(const std::string& path);

/// "PATH: No such file or directory"
std::string trouble(const std::string& path, int error);

}  // namespace adit::host
