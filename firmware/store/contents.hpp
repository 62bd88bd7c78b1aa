#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "store/directory.hpp"
#include "store/frame.hpp"

namespace adit::store {

/// How a log is kept.
struct Keeping {
  Layout layout = kOnDisk;
  std::size_t file_bytes = 8u << 20;  // of one file, which then is full; a longer record gets a longer file
  bool syncs = true;  // false: the log is in memory, its files grow, and each append is durable
};

struct Record {
  std::uint64_t sequence = 0;  // 0: of a snapshot
  std::uint8_t kind = 0;
  std::string_view body = {};
};
/// Records that were synced, or written to a log in memory, and are not there.
struct Gap {
  std::uint64_t first = 0;                           // 0: of a snapshot
  std::optional<std::uint64_t> last = std::nullopt;  // nothing: unknown
  std::string file = "";                             // where the gap was found
};
using Item = std::variant<Record, Gap>;

/// The first frame of each file.
struct FileHeader {
  static constexpr std::uint64_t kVersion = 1;
  std::uint64_t version = kVersion;
  std::uint64_t number = 0;
  std::uint64_t salt = 0;
  /// Of a log: each record above it in an earlier file is void. Of a snapshot: it holds all up to it.
  std::uint64_t base = 0;
  std::uint64_t size = 0;  // bytes that were written and synced before this; 0: the file grows
  std::string written() const;
  static std::optional<FileHeader> parse(std::string_view body);
};

/// All that a log's directory holds, in order: what the newest whole snapshot says, then the records behind
/// it, with each gap in its place.
class Contents {
 public:
  static constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
  /// Reads alone: changes nothing. An error if a file cannot be read, or a later version wrote it. `before`:
  /// logs of this number and above are left out.
  static Result<Contents> read(const Directory& directory, const Keeping& keeping,
                               std::uint64_t before = kAll);

  /// Whether the log of this number was read, or a snapshot stands for it.
  bool has(std::uint64_t one) const { return one < snapshot || std::ranges::find(logs, one) != logs.end(); }

  Contents() = default;
  Contents(Contents&&) = default;
  Contents& operator=(Contents&&) = default;

  std::vector<Item> items;
  std::vector<std::string> notes;   // sentences about damage that cost no record
  bool is_new = false;              // the directory holds neither a log nor a snapshot
  std::uint64_t snapshot = 0;       // number of the one that was read; 0: none
  std::vector<std::uint64_t> logs;  // numbers of those that were read

  // What a log that goes on must know.
  std::uint64_t last = 0;       // sequence number of the last record, or of the last that is missing
  std::uint64_t durable = 0;    // the highest number that is known to be synced
  std::uint64_t process = 0;    // the highest number of a process
  std::uint64_t number = 0;     // the highest one of a file
  std::optional<FileName> log;  // the last one, whose frames end at `end`
  std::size_t end = 0, size = 0;
  /// Frames that may be in memory alone, or have a damaged copy, and the header of the last log: written
  /// again at the start.
  struct Rewrite {
    FileName file;
    std::size_t offset;
    Frame frame;
  };
  std::vector<Rewrite> rewrites;

 private:
  friend class Assembly;
  std::vector<std::string> bytes_;  // of the files: items and rewrites show parts of it
};

/// The layout of a snapshot in a directory with logs of this one: it is synced before it has its name.
inline Layout snapshot_layout(const Layout& layout) {
  return {8, layout.copies};
}

}  // namespace adit::store
