#pragma once

#include <atomic>
#include <cstdint>
#include <expected>
#include <string>
#include <vector>

#include "journal/carried.hpp"

namespace adit::journal {

/// The folder of a journal: files `journal-N` of records as they came, one after the other, and
/// `snapshot-N`, which holds what all journals before N come to. It is read from the newest whole snapshot
/// on.
class Folder {
 public:
  /// Makes it, for this user alone.
  explicit Folder(std::string path);

  std::string journal(std::uint64_t number) const { return file("journal-", number); }
  std::string snapshot(std::uint64_t number) const { return file("snapshot-", number); }

  /// What the files up to `journal-last` come to. Unknown records are logged. An error if a file, or the
  /// folder, cannot be read. `enough`: to be left half way, when the outcome is of no use any more.
  std::expected<Carried, std::string> read(std::uint64_t last, const std::atomic<bool>& enough) const;
  std::expected<Carried, std::string> read() const;

  /// The highest number of any file; 0: there is none.
  std::expected<std::uint64_t, std::string> last() const;

  /// Writes a snapshot of all up to `journal-last`, and removes what it stands for. Its size in bytes, or a
  /// sentence why not.
  std::expected<std::size_t, std::string> compact(std::uint64_t last, const std::atomic<bool>& enough);

 private:
  struct Files {
    std::vector<std::uint64_t> journals, snapshots;  // in order
    std::vector<std::string> parts;                  // of snapshots that are not whole
  };
  std::string file(const char* kind, std::uint64_t number) const;
  std::expected<Files, std::string> files() const;
  void remove_before(std::uint64_t number);

  std::string path_;
};

}  // namespace adit::journal
