#pragma once

#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include "applier/spare_options.hpp"
#include "spare/medium.hpp"

namespace adit::applier {

/// The USB sticks that are in. systemd mounts them, each file system in a folder of its own
/// (services/adit-stick@.service).
class Sticks {
 public:
  enum class Mode : std::uint8_t { ReadOnly, Writable };

  /// Outlives this.
  explicit Sticks(const SpareOptions& options) : options_(options) {}

  std::vector<spare::Medium> media() const;
  /// Where that one is mounted.
  std::string folder(const std::string& name) const { return options_.sticks + '/' + name; }
  bool is_in(const std::string& name) const;

  /// Names at the top of a stick, of whatever.
  static constexpr std::size_t kMostAtTop = 4096;
  /// Names of exports on all that are mounted, the latest first: at most kMost.
  static constexpr std::size_t kMost = 8;
  std::vector<std::string> exports() const;
  /// The folder in which an export of that name is; "": in none.
  std::string folder_with(const std::string& name) const;

  /// Mounts it so, in place of how it was mounted: then what was written is on the stick. An error is a
  /// sentence.
  std::expected<void, std::string> remount(const std::string& name, Mode mode) const;
  /// What a program that was killed left writable is not any more.
  void settle() const;

 private:
  bool is_mounted(const std::string& name) const;
  std::expected<void, std::string> unmount(const std::string& name) const;

  const SpareOptions& options_;
};

}  // namespace adit::applier
