#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"

namespace adit::host {

/// A folder in which somebody else writes: for a program with more rights than whoever does. Nothing in it is
/// followed elsewhere, waited for, or believed to be small.
class UntrustedFolder {
 public:
  static constexpr std::size_t kLargest = 65536;

  /// An error where it is not there, or is no folder itself but a link to one.
  static std::expected<UntrustedFolder, std::string> open(const std::string& path);

  struct Untaken {
    std::string why = "";
    bool stays = false;  // what has the name cannot be taken away, and would be found again and again
  };
  /// Takes a file away and gives what was in it; nothing where there is none of that name. An error: it was
  /// no plain file, too large or unreadable, and is gone all the same, or it stays.
  std::expected<std::optional<std::string>, Untaken> take(const std::string& name);

  /// Takes away whatever has that name. Of a folder that cannot be deleted (it may be deeper than files can
  /// be opened) the name at least: what is left is beside it, as NAME.XXXXXX.
  std::expected<void, std::string> remove(const std::string& name);

  /// What is in a file, which stays; nothing where there is none of that name. An error: it is no plain file,
  /// too large or unreadable.
  std::expected<std::optional<std::string>, std::string> read(const std::string& name) const;

  /// A folder in it; nothing where there is none of that name.
  std::expected<std::optional<UntrustedFolder>, std::string> folder(const std::string& name) const;

  /// names_in() it.
  std::expected<std::vector<std::string>, std::string> names() const;

  /// Removes a file so that its text is not left on the disk: overwritten, then unlinked. False: it may still
  /// be there.
  bool wipe(const std::string& name);

  /// For inotify(7): names the folder itself, whatever its path has come to mean.
  std::string path_by_descriptor() const;

 private:
  explicit UntrustedFolder(loop::FileDescriptor folder) : folder_(std::move(folder)) {}
  loop::FileDescriptor folder_;
};

}  // namespace adit::host
