#pragma once

#include <cstddef>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "loop/file_descriptor.hpp"

namespace adit::host {

/// A directory that a less privileged user writes. Operations follow no links, never block, and limit sizes.
class UntrustedFolder {
 public:
  static constexpr std::size_t kLargest = 65536;

  /// Error: the directory does not exist, or is a link.
  static std::expected<UntrustedFolder, std::string> open(const std::string& path);

  struct ReadFailure {
    std::string why = "";
    bool stays = false;  // cannot be removed, and would be found again
  };
  /// Removes a file and returns its content. std::nullopt: no such file. Error: not a plain file, too large
  /// or unreadable; removed in any case unless `stays`.
  std::expected<std::optional<std::string>, ReadFailure> take_file(const std::string& name);

  /// Removes an entry of any type. If a directory cannot be deleted (it may be deeper than files can be
  /// opened), frees its name: the rest is NAME.XXXXXX.
  std::expected<void, std::string> remove(const std::string& name);

  /// The content of a file; std::nullopt: no such file. Error: not a plain file, too large or unreadable.
  std::expected<std::optional<std::string>, std::string> read(const std::string& name) const;

  /// A subdirectory, or std::nullopt if it does not exist.
  std::expected<std::optional<UntrustedFolder>, std::string> folder(const std::string& name) const;

  /// As names_in().
  std::expected<std::vector<std::string>, std::string> names() const;

  /// Overwrites and unlinks a file, so that its text does not stay on the disk. False: it may still exist.
  bool wipe(const std::string& name);

  /// A path for inotify(7) that always means this directory.
  std::string path_by_descriptor() const { return "/proc/self/fd/" + std::to_string(folder_.get()); }

 private:
  explicit UntrustedFolder(loop::FileDescriptor folder) : folder_(std::move(folder)) {}
  loop::FileDescriptor folder_;
};

}  // namespace adit::host
