#pragma once

#include <cstdint>
#include <expected>
#include <span>
#include <string>
#include <vector>

#include "applier/options.hpp"
#include "spare/stick.hpp"

namespace adit::applier {

/// Temporary name. The next export replaces a file that remains after the stick was pulled out.
inline constexpr const char* kUnfinished = "adit-spare.part";

/// Writes an export into a directory that another user may have made, without following links. A crash leaves
/// the old file or the new one: temporary name, fsync, rename, sync of the file system. A failed write is
/// removed. An error is a sentence without the directory's name.
std::expected<void, std::string> write_export(const std::string& folder, const std::string& name,
                                              const std::string& bytes);

/// Reads an export likewise, without blocking. Error: no plain file, unreadable, above spare::kLargestExport.
std::expected<std::string, std::string> read_export(const std::string& folder, const std::string& name);

/// USB sticks. systemd mounts each file system in a directory of its own (services/adit-stick@.service).
class Sticks {
 public:
  enum class Mode : std::uint8_t { ReadOnly, Writable };

  /// `options` must outlive this object.
  explicit Sticks(const SpareOptions& options) : options_(options) {}

  /// An error is a sentence.
  std::expected<std::vector<spare::Medium>, std::string> media() const;
  /// Its mount point.
  std::string folder(const std::string& name) const { return options_.sticks + '/' + name; }
  bool is_in(const std::string& name) const;

  /// Names read at the top of a stick.
  static constexpr std::size_t kMostAtTop = 4096;
  /// Names of exports on all mounted sticks, the latest first, at most kMost. `unreadable`: without an
  /// export, why a stick cannot be read, or "".
  static constexpr std::size_t kMost = 8;
  std::vector<std::string> exports(std::span<const spare::Medium> media, std::string& unreadable) const;
  /// The directory that has an export of that name. An error is a sentence.
  std::expected<std::string, std::string> folder_with(const std::string& name) const;

  /// Unmounts the stick, which completes its writes, and mounts it in `mode`. Errors are sentences.
  std::expected<void, std::string> remount(const std::string& name, Mode mode) const;
  /// Mounts sticks read-only that a killed program left writable.
  void settle() const;

 private:
  /// False only if it is known not to be mounted.
  bool is_mounted(const std::string& name) const;
  std::expected<void, std::string> unmount(const std::string& name) const;

  const SpareOptions& options_;
};

}  // namespace adit::applier
