#pragma once

#include <cstddef>
#include <expected>
#include <string>

/// An export's file in a folder that somebody else may have made: nothing in it is followed elsewhere, waited
/// for, or believed to be small. Errors are sentences without the folder's name.
namespace adit::applier {

/// While it is written: one that a stick kept when it was pulled out goes with the next export.
inline constexpr const char* kUnfinished = "adit-spare.part";

/// Writes it so that after a crash there is the old file of that name or the new one: under another name,
/// fsync, rename, and a sync of the whole file system. What fails is taken away again.
std::expected<void, std::string> write_export(const std::string& folder, const std::string& name,
                                              const std::string& bytes);

/// All of it. An error: it is no plain file, is unreadable or has more than spare::kLargestExport bytes.
std::expected<std::string, std::string> read_export(const std::string& folder, const std::string& name);

}  // namespace adit::applier
