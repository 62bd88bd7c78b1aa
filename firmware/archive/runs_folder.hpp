#pragma once

#include <cstdint>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/run_folder.hpp"
#include "archive/said.hpp"
#include "codec/row_file.hpp"

namespace adit::archive {

/// The folder of all runs: each has a folder in it, whose name is its key. For one thread, which waits for
/// the disk.
class RunsFolder {
 public:
  static constexpr const char* kName = "runs";
  static constexpr std::size_t kMostRuns = 2000;  // that are looked at

  explicit RunsFolder(const std::string& state_folder) : path_(state_folder + '/' + kName) {}

  /// All that there is, the latest first. A run whose facts are damaged is known by its files. One that
  /// cannot be read is logged.
  std::vector<api::RunRow> list() const;
  /// Makes the run's folder if it does not exist, and returns its key. An error: the folder cannot be made,
  /// or a folder that may be the run's cannot be read.
  std::expected<std::string, std::string> begin(const Head& head);
  std::string folder_of(const std::string& key) const { return path_ + '/' + key; }
  bool has(const std::string& key) const;
  /// Empty if the run does not exist, or if its files do not say which run it is. An error names the file
  /// that cannot be read.
  std::expected<std::optional<api::RunRow>, std::string> facts_of(const std::string& key) const;
  std::expected<void, std::string> remove(const std::string& key);
  /// Removes the oldest until all take at most `most` bytes, and at most half of what the disk has for them;
  /// never `present`. Also what a death left of a removal.
  void tidy(std::uint64_t most, const std::string& present);

  /// A name that begin() gives: a run's number, and more where two runs have the same.
  static bool is_key(std::string_view name);

 private:
  std::string path_;
};

}  // namespace adit::archive
