#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "loop/regular_file.hpp"
#include "store/error.hpp"

namespace adit::store {

/// A file of a log. Its name is "log-NUMBER.SALT", "snapshot-NUMBER.SALT" or "spare-NUMBER.SALT": 8 decimal
/// digits at least, and 16 hexadecimal ones.
struct FileName {
  enum class Kind : std::uint8_t { Log, Snapshot, Spare };
  Kind kind = Kind::Log;
  std::uint64_t number = 0;
  std::uint64_t salt = 0;  // random: nobody else can make bytes that look like a frame of this file
  std::string text() const;
};

/// The directory of one log, open. Names are below it.
class Directory {
 public:
  /// A file that is not whole has a name that ends so until it is renamed.
  static constexpr std::string_view kPart = ".part";

  /// Makes it for this user alone if it is absent, and locks it: one process at a time writes a log.
  static Result<Directory> lock(const std::string& path);
  /// To read it alone, also while another process has the lock.
  static Result<Directory> look(const std::string& path);

  /// The files of the log, by kind and number. An error if the directory cannot be
  /// read, never an empty list.
  Result<std::vector<FileName>> files() const;
  /// All bytes of a regular file.
  Result<std::string> read(const std::string& name) const;
  /// A new file for writing; an error if one has that name.
  Result<loop::FileDescriptor> make(const std::string& name) const;
  Result<loop::FileDescriptor> open_to_write(const std::string& name) const;
  /// In bytes; nothing if that cannot be told.
  std::optional<std::uint64_t> size(const std::string& name) const;
  Result<void> rename(const std::string& from, const std::string& to) const;
  Result<void> remove(const std::string& name) const;
  /// Removes the files that a kill left without their name.
  Result<void> remove_parts() const;
  /// Links the files of a damaged log, as they are, into a new directory below this one.
  Result<void> put_aside() const;
  /// Renames `name` to the first NAME.damaged-1, -2 ... that is free. Its new name.
  Result<std::string> rename_aside(const std::string& name) const;
  /// Syncs the names.
  Result<void> sync() const;
  /// Syncs its own name.
  Result<void> sync_name() const;
  std::unexpected<Error> trouble(const std::string& name, int number) const {
    return failed(path_ + '/' + name, number);
  }
  /// Of a write: its file's name is another one at each try.
  std::unexpected<Error> trouble(int number) const { return failed(path_, number); }

 private:
  static Result<Directory> open(const std::string& path);
  Result<std::vector<std::string>> names() const;
  /// The first of `beginning`1, 2 ... that nothing has.
  Result<std::string> first_free(const std::string& beginning) const;

  loop::FileDescriptor fd_;
  std::string path_;
};

using loop::write_all;

/// 64 random bits of the kernel's.
Result<std::uint64_t> random_salt();

}  // namespace adit::store
