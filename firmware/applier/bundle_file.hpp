#pragma once

#include <expected>
#include <string>

#include "host/untrusted_folder.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::applier {

/// An update's file that nobody can change while it is looked at and installed.
class BundleFile {
 public:
  /// Takes the file of that name out of a folder in which somebody else writes: its name is gone, it belongs
  /// to this user, and nobody has it open for writing. An error says what it is; it is gone all the same,
  /// where it can be taken away.
  static std::expected<BundleFile, std::string> take(host::UntrustedFolder& folder, const std::string& name);
  /// Opens one where nobody writes: a file system that is mounted read-only.
  static std::expected<BundleFile, std::string> open(const std::string& path);

  /// By which other programs of this user reach the very file, as long as this lives.
  std::string path() const;

 private:
  explicit BundleFile(loop::FileDescriptor file) : file_(std::move(file)) {}
  loop::FileDescriptor file_;
};

}  // namespace adit::applier
