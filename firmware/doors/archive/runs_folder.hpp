#pragma once

#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/record_kinds.hpp"
#include "archive/run_folder.hpp"
#include "codec/row_file.hpp"

namespace adit::archive {

/// The directory of all runs, with a subdirectory for each, named by its key. Use from one thread; it blocks
/// on the disk.
class RunsFolder {
 public:
  static constexpr const char* kName = "runs";
  static constexpr std::size_t kMostRuns = 2000;  // most entries read

  explicit RunsFolder(const std::string& state_folder) : path_(state_folder + '/' + kName) {}

  struct List {
    std::vector<api::RunRow> runs;  // the latest first
    std::string unreadable;         // why a run may be missing; empty: none is
  };
  /// All runs. A run with damaged facts is read from its other files; an unreadable run is logged. Error: the
  /// directory cannot be listed.
  std::expected<List, std::string> list() const;
  /// Creates the run's directory if it does not exist, and returns its key. Error: the directory cannot be
  /// created, or a directory that may be the run's cannot be read.
  std::expected<std::string, std::string> begin(const Head& head);
  std::string folder_of(const std::string& key) const { return path_ + '/' + key; }
  /// Whether the run has a directory. Error: unknown.
  std::expected<bool, std::string> has(const std::string& key) const;
  /// std::nullopt if the run does not exist, or its files do not identify it. An error names the unreadable
  /// file.
  std::expected<std::optional<api::RunRow>, std::string> facts_of(const std::string& key) const;
  std::expected<void, std::string> remove(const std::string& key);
  /// Removes the oldest runs until all take at most `most` bytes, and at most half of the available space;
  /// never `present`. Also completes interrupted removals.
  void tidy(std::uint64_t most, const std::string& present);

  /// Whether a name has begin()'s form: a run's number, and a suffix if two runs share it.
  static bool is_key(std::string_view name);

 private:
  std::string path_;
};

}  // namespace adit::archive
