#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "ledger/database.hpp"
#include "loop/regular_file.hpp"

namespace adit::ledger {

/// By errno.
Error system_error(const std::string& doing);

/// A name that cannot be looked at is taken: nothing may be put in its place.
bool exists(const std::string& path);
/// Keeps other processes out of a folder until the descriptor is closed (flock(2)). A failure if one is in
/// it.
Result<loop::FileDescriptor> lock_folder(const std::string& folder);
/// All of a file; one that is not there is empty.
Result<std::string> read_file(const std::string& path);
/// A failure if the file is there, and cannot be opened or is no regular file, for which SQLite would wait.
Result<void> check_regular(const std::string& path);
/// Makes an empty file of mode 0600 where there is none; SQLite gives its -wal the same mode.
Result<void> make_file(const std::string& path);
/// A new or renamed file outlives a power cut only once its folder is on disk too.
Result<void> sync_folder(const std::string& folder);
/// A failure with `read_only`: no file can be made in it.
Result<void> try_writing(const std::string& folder);
/// A failure where `bytes` have no room in it.
Result<void> try_room(const std::string& folder, std::int64_t bytes);
/// The paths of what is in a folder whose names begin so, as far as it can be read.
std::vector<std::string> beginning_with(const std::string& folder, std::string_view begins);
/// Of try_writing() and try_room() a program that was killed in the middle has left a file.
void remove_trials(const std::string& folder);
/// A failure where the file is there and cannot be written to, or is not ours.
Result<void> try_opening(const std::string& path);
/// In bytes; 0: it is not there.
std::int64_t size_of(const std::string& path);
Result<void> rename_file(const std::string& from, const std::string& to);
/// Copies a database with what SQLite keeps beside it, as far as it is there and can be read.
Result<void> copy_database(const std::string& from, const std::string& to);
/// A database with what SQLite keeps beside it.
void remove_database(const std::string& path);
/// Renames the file and what SQLite keeps beside it, as far as they are there, to the first `damaged-<n>`
/// that is free, and gives that.
Result<std::string> set_aside(const std::string& folder, const std::string& path);

}  // namespace adit::ledger
