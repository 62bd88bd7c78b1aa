#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/record_kinds.hpp"
#include "archive/run_records.hpp"
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

/// A sequence of files. Records are appended to the last file until it is full. Readers skip a torn end,
/// which a crash leaves.
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
  std::expected<void, std::string> look();
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

  struct Written {
    std::uint64_t file = 0;        // number of the tile file
    std::uint64_t first_file = 0;  // first tile file, or 0 if there are fewer than two
    std::uint64_t bytes = 0;       // of the run
  };
  /// `most`: limit of the run in bytes; half of the available space also limits it. Removes first files
  /// beyond the limit. After an error no lines were written; other data may have been, and may be written
  /// again.
  std::expected<Written, std::string> write(const Batch& batch, std::uint64_t most);
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

}  // namespace adit::archive
