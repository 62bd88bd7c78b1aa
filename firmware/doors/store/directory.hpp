#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "loop/regular_file.hpp"

namespace adit::store {

/// Why a log could not be read or written.
struct Error {
  enum class Cause : std::uint8_t {
    Full,     // the disk is full (ENOSPC, EDQUOT)
    NoWrite,  // this process may not write the directory (EROFS, EACCES, EPERM)
    Failing,  // the disk reports an error (EIO)
    InUse,    // another process has locked the log
    Newer,    // a later version wrote it
    TooLong,  // a record is longer than kMostBody
    Other,
  };
  Cause cause = Cause::Other;
  std::string what = "";  // a sentence
};

template <class T>
using Result = std::expected<T, Error>;

/// "PATH: No such file or directory", with the cause of errno `number`.
std::unexpected<Error> path_error(const std::string& path, int number);

/// A file of a log, named "log-NUMBER.SALT", "snapshot-NUMBER.SALT" or "spare-NUMBER.SALT", with at least 8
/// decimal and 16 hexadecimal digits.
struct FileName {
  enum class Kind : std::uint8_t { Log, Snapshot, Spare };
  Kind kind = Kind::Log;
  std::uint64_t number = 0;
  std::uint64_t salt = 0;  // random, so that other data cannot look like a frame of this file
  std::string text() const;
};

/// The open directory of one log. File names are relative to it.
class Directory {
 public:
  /// Ending of an incomplete file's name, until it is renamed.
  static constexpr std::string_view kPart = ".part";

  /// Creates the directory for this user alone if it is absent, and locks it, because one process at a time
  /// may write a log.
  static Result<Directory> lock(const std::string& path);
  /// For reading, even while another process has the lock.
  static Result<Directory> open(const std::string& path);

  /// The log's files by kind and number. Error if the directory cannot be read, never an empty list.
  Result<std::vector<FileName>> files() const;
  /// The first `most` bytes of a regular file.
  Result<std::string> read(const std::string& name, std::size_t most) const;
  /// Creates a file for writing. Error if the name exists.
  Result<loop::FileDescriptor> make(const std::string& name) const;
  Result<loop::FileDescriptor> open_to_write(const std::string& name) const;
  /// In bytes; std::nullopt if unknown.
  std::optional<std::uint64_t> size(const std::string& name) const;
  Result<void> rename(const std::string& from, const std::string& to) const;
  Result<void> remove(const std::string& name) const;
  /// Removes incomplete files of a killed process.
  Result<void> remove_parts() const;
  /// Links the files of a damaged log unchanged into a new directory below this one.
  Result<void> put_aside() const;
  /// Renames `name` to the first free NAME.damaged-1, -2 ... and returns the new name.
  Result<std::string> rename_aside(const std::string& name) const;
  /// Syncs the file names.
  Result<void> sync() const;
  /// Syncs the directory's own name.
  Result<void> sync_name() const;
  std::unexpected<Error> file_error(const std::string& name, int number) const {
    return path_error(path_ + '/' + name, number);
  }
  /// For write errors: names the directory, because the file's name differs at each try.
  std::unexpected<Error> file_error(int number) const { return path_error(path_, number); }

 private:
  Result<std::vector<std::string>> names() const;
  /// The first free name of `beginning`1, 2 ...
  Result<std::string> first_free(const std::string& beginning) const;

  loop::FileDescriptor fd_;
  std::string path_;
};

using loop::write_all;

/// 64 random bits of the kernel.
Result<std::uint64_t> random_salt();

}  // namespace adit::store
