#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/record_kinds.hpp"
#include "archive/run_records.hpp"
#include "codec/row.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::archive {

/// The data of one write.
struct Batch {
  std::vector<TileState> tiles = {};
  std::string beside = "";  // records for the tile file
  std::string lines = "";   // records of tracks, plots and attention
  std::string facts = "";   // file of facts; "": unchanged
  bool is_empty() const { return tiles.empty() && beside.empty() && lines.empty() && facts.empty(); }
};

/// Files, of which the last gets new records until it is full. Readers skip a torn end, which a crash leaves.
class GrowingFile {
 public:
  /// `head`: the first record of each file.
  GrowingFile(std::string folder, std::string prefix, std::string head);

  /// Appends all or none, and syncs. Returns the file's number.
  std::expected<std::uint64_t, std::string> append(std::string_view bytes, std::size_t largest);
  std::uint64_t bytes() const;
  /// Number of the first file, or 0 if there are fewer than two.
  std::uint64_t first() const { return files_.size() > 1 ? files_.front().number : 0; }
  /// Removes the first file. Call only if there is one.
  std::expected<void, std::string> remove_first();
  /// Removes first files until the rest has at most `most` bytes, but never the last file.
  std::expected<void, std::string> shrink(std::uint64_t most);

 private:
  struct File {
    std::uint64_t number, size;
  };
  /// Reads the existing files, once successfully, so that a number is not used twice.
  std::expected<void, std::string> scan();
  std::string path(std::uint64_t number) const;

  std::string folder_, prefix_, head_;
  bool has_looked_ = false;
  std::vector<File> files_;  // in order
  loop::FileDescriptor fd_;  // of the last file
};

/// The files of one run. Use from one thread; it blocks on the disk.
class RunFolder {
 public:
  static constexpr const char* kFacts = "facts.json";
  /// Bytes left to the ledger and others, or a quarter of a small disk. With less free space, writes fail.
  static constexpr std::uint64_t kLeave = std::uint64_t{16} << 20;

  RunFolder(std::string path, const Head& head);

  struct WriteResult {
    std::uint64_t file = 0;        // number of the tile file
    std::uint64_t first_file = 0;  // first tile file, or 0 if there are fewer than two
    std::uint64_t bytes = 0;       // of the run
  };
  /// `most`: limit of the run in bytes; half of the available space also limits it. Removes first files
  /// beyond it. After an error no lines were written; other data may have been, and may be written again.
  std::expected<WriteResult, std::string> write(const Batch& batch, std::uint64_t most);
  /// Removes that tile file if it is the first of several.
  void remove_first(std::uint64_t file);
  std::uint64_t bytes() const { return tiles_.bytes() + lines_.bytes(); }

 private:
  std::string path_;
  GrowingFile tiles_, lines_;
};

/// Reads a run's files into `told` until `enough` returns true. An error names the first unreadable file; all
/// others are read.
std::expected<void, std::string> read_run(const std::string& folder, RunRecords& told,
                                          const std::function<bool()>& enough);
/// Whether the run has no files. Error: it cannot be read.
std::expected<bool, std::string> is_blank(const std::string& folder);

/// The runs' directory, each run in a subdirectory named by its key. Use from one thread; blocks on the disk.
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
  /// std::nullopt: no such run, or its files do not identify it. An error names the unreadable file.
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
