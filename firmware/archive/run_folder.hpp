#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "api/kept_runs.hpp"
#include "archive/said.hpp"
#include "archive/told.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::archive {

/// What one write is to put on the disk.
struct Batch {
  std::vector<TileState> tiles = {};
  std::string beside = "";  // records that go with the tiles
  std::string lines = "";   // records of tracks, plots and what needed the operator
  std::string facts = "";   // the file of facts; "": as it is
  bool is_empty() const { return tiles.empty() && beside.empty() && lines.empty() && facts.empty(); }
};

/// A file that grows, one after the other: records are appended to the last one until it is full. What a
/// death left torn at its end is passed over by who reads it.
class GrowingFile {
 public:
  /// `head`: the record that begins each.
  GrowingFile(std::string folder, std::string prefix, std::string head);

  /// All of it or nothing, and on the disk when this returns. Gives the number of the file.
  std::expected<std::uint64_t, std::string> append(std::string_view bytes, std::size_t largest);
  std::uint64_t bytes() const;
  /// The number of the first of several files; 0: there is one, or none.
  std::uint64_t first() const { return files_.size() > 1 ? files_.front().number : 0; }
  /// Removes that one.
  std::expected<void, std::string> remove_first();
  /// The first files go, until the others have at most so many bytes.
  std::expected<void, std::string> shrink(std::uint64_t most);

 private:
  struct File {
    std::uint64_t number, size;
  };
  /// At what there is, until it could be read: a number that was given is not given again.
  std::expected<void, std::string> look();
  std::string path(std::uint64_t number) const;

  std::string folder_, prefix_, head_;
  bool has_looked_ = false;
  std::vector<File> files_;  // in order
  loop::FileDescriptor fd_;  // of the last one
};

/// The files of one run. For one thread, which waits for the disk.
class RunFolder {
 public:
  static constexpr const char* kFacts = "facts.json";
  /// What is left to the ledger and all else, in bytes, or a quarter of a small disk: below it nothing is
  /// written.
  static constexpr std::uint64_t kLeave = std::uint64_t{16} << 20;

  RunFolder(std::string path, const Head& head);

  struct Written {
    std::uint64_t file = 0;        // that has the tiles
    std::uint64_t first_file = 0;  // of those with tiles
    std::uint64_t bytes = 0;       // of the run
  };
  /// `most`: bytes that the run may take, and half of what the disk has for it. Beyond it the first files go.
  /// Where it fails, no lines were written. The rest may have been, and may be written again.
  std::expected<Written, std::string> write(const Batch& batch, std::uint64_t most);
  /// The first of several files with tiles goes.
  void remove_first(std::uint64_t file);
  std::uint64_t bytes() const { return tiles_.bytes() + lines_.bytes(); }

 private:
  std::string path_;
  GrowingFile tiles_, lines_;
};

/// Reads a run's files into `told`, until `enough`. An error names the first file that cannot be read; all
/// other files are read.
std::expected<void, std::string> read_run(const std::string& folder, Told& told,
                                          const std::function<bool()>& enough);
/// Whether nothing was ever written into it. An error: it cannot be read.
std::expected<bool, std::string> is_blank(const std::string& folder);

}  // namespace adit::archive
