#pragma once

#include <expected>
#include <string>

/// An export's file in a directory that another user may have made. Reads and writes do not follow links, do
/// not block, and limit the size. Errors are sentences without the directory's name.
namespace adit::applier {

/// Temporary name. The next export replaces a file that remains after the stick was pulled out.
inline constexpr const char* kUnfinished = "adit-spare.part";

/// Writes the file so that a crash leaves the old file or the new one: temporary name, fsync, rename, sync of
/// the file system. A failed write is removed.
std::expected<void, std::string> write_export(const std::string& folder, const std::string& name,
                                              const std::string& bytes);

/// Reads the whole file. Error: not a plain file, unreadable, or longer than spare::kLargestExport.
std::expected<std::string, std::string> read_export(const std::string& folder, const std::string& name);

}  // namespace adit::applier
