#pragma once

#include <expected>
#include <string>

#include "host/untrusted_folder.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::applier {

/// An update's file that other users cannot change during checks and installation.
class BundleFile {
 public:
  /// Takes a file out of a directory in which another user writes. The file has no name afterwards, belongs
  /// to this user and is open for writing in no process. After an error the file is still removed, if
  /// possible.
  static std::expected<BundleFile, std::string> take(host::UntrustedFolder& folder, const std::string& name);
  /// Opens a file on a read-only file system.
  static std::expected<BundleFile, std::string> open(const std::string& path);

  /// Path of the same file for other programs of this user, valid while this object lives.
  std::string path() const;

 private:
  explicit BundleFile(loop::FileDescriptor file) : file_(std::move(file)) {}
  loop::FileDescriptor file_;
};

}  // namespace adit::applier
