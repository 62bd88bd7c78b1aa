#pragma once

#include <sys/stat.h>

#include <cstddef>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace adit::host {

inline constexpr std::size_t kLargestFile = 1u << 20;

struct File {
  std::string text;
  struct stat status;  // of the file that was read
};

/// The text, or errno; EFBIG above `most` bytes.
std::expected<File, int> slurp(const std::string& path, std::size_t most = kLargestFile);
/// The text without the last line of write_kept(), if its checksum is right.
std::string strip_checksum(std::string text);

/// Syncs the directory of this file, so that the file's name survives a power cut. False: see errno.
bool sync_folder(const std::string& path);

/// "PATH: No such file or directory"
std::string path_error(const std::string& path, int error);

/// The name of a numbered file, with at least eight digits: "map-00000012.cbor".
std::string numbered_name(std::string_view prefix, std::uint64_t number, std::string_view ending = "");

/// The number in such a name, with any count of digits. std::nullopt for other names.
std::optional<std::uint64_t> number_in_name(std::string_view name, std::string_view prefix,
                                            std::string_view ending = "");

/// The numbers of such files in a directory, sorted. Empty if there is no such directory. Error, with the
/// directory's name: it cannot be read completely.
std::expected<std::vector<std::uint64_t>, std::string> numbers_in(const std::string& folder,
                                                                  std::string_view prefix,
                                                                  std::string_view ending = "");

}  // namespace adit::host
