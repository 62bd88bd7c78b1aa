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

/// Storage of a log.
struct LogOptions {
  Layout layout = kOnDisk;
  std::size_t file_bytes = 8u << 20;  // of one file; a longer record gets a longer file
  bool syncs = true;  // false: the log is in memory, its files grow, and every append is durable
  /// Of a file whose header names no size: one that grows, or a snapshot. A longer one is read up to here.
  std::size_t most_bytes = 128u << 20;
  /// Of a file on a disk that has no room for `file_bytes`, besides its first records.
  std::size_t least_bytes = 512u << 10;
};

struct Record {
  std::uint64_t sequence = 0;  // 0: in a snapshot
  std::uint8_t kind = 0;
  std::string_view body = {};
};
/// Missing records that were synced, or written to a log in memory.
struct Gap {
  std::uint64_t first = 0;                           // 0: in a snapshot
  std::optional<std::uint64_t> last = std::nullopt;  // nullopt: unknown
  std::string file = "";                             // the file with the gap
};
using Item = std::variant<Record, Gap>;

/// The first frame of each file.
struct FileHeader {
  static constexpr std::uint64_t kVersion = 1;
  std::uint64_t version = kVersion;
  std::uint64_t number = 0;
  std::uint64_t salt = 0;
  /// Of a log: records above it in earlier files are void. Of a snapshot: it contains all records up to it.
  std::uint64_t base = 0;
  std::uint64_t size = 0;  // bytes written and synced before this header; 0: the file grows
  std::string to_bytes() const;
  static std::optional<FileHeader> parse(std::string_view body);
};

/// A log directory's content in order: the newest whole snapshot, later records, and gaps in their places.
class Contents {
 public:
  static constexpr std::uint64_t kAll = std::numeric_limits<std::uint64_t>::max();
  /// Reads without changes. Error: a file cannot be read, or a later version wrote it. `before`: skips logs
  /// with this number and above.
  static Result<Contents> read(const Directory& directory, const LogOptions& keeping,
                               std::uint64_t before = kAll);

  /// Whether that log was read, or is contained in the snapshot.
  bool has(std::uint64_t one) const { return one < snapshot || std::ranges::find(logs, one) != logs.end(); }

  Contents() = default;
  Contents(Contents&&) = default;
  Contents& operator=(Contents&&) = default;

  std::vector<Item> items;
  std::vector<std::string> notes;   // sentences about damage without a lost record
  bool is_new = false;              // the directory has neither a log nor a snapshot
  std::uint64_t snapshot = 0;       // number of the snapshot read; 0: none
  std::vector<std::uint64_t> logs;  // numbers of the logs read

  // State for a log that continues.
  std::uint64_t last = 0;       // sequence number of the last record, present or missing
  std::uint64_t durable = 0;    // highest sequence number known to be synced
  std::uint64_t process = 0;    // highest process number
  std::uint64_t number = 0;     // highest file number
  std::optional<FileName> log;  // the last log, whose frames end at `end`
  std::size_t end = 0, size = 0;
  /// Frames to write again at the start: maybe unsynced, or with a damaged copy; and the last log's header.
  struct Rewrite {
    FileName file;
    std::size_t offset;
    Frame frame;
  };
  std::vector<Rewrite> rewrites;

 private:
  friend class Assembly;
  std::vector<std::string> bytes_;  // of the files; items and rewrites refer to them
};

/// The layout of a snapshot for logs of this layout. A snapshot is synced before it gets its name.
inline Layout snapshot_layout(const Layout& layout) {
  return {8, layout.copies};
}

/// A log file as found.
struct Scan {
  struct FoundFrame {
    Frame frame;
    std::size_t offset;  // of its first copy
    std::size_t good;    // good copies
  };
  FileName name;
  std::size_t size = 0;
  std::optional<FoundFrame> begin = std::nullopt;  // the file's header
  std::optional<FileHeader> header = std::nullopt;
  std::vector<FoundFrame> frames = {};  // all other frames, in order
  std::uint64_t process = 0;            // highest process number in a frame
};

/// Finds all frames with a good copy. Skips frames of an older process after those of a newer one, because
/// the newer process did not know them.
Scan scan(const FileName& name, std::string_view bytes, const Layout& layout);

/// Whether a snapshot has all records and its end.
bool is_whole_snapshot(const Scan& scan);

}  // namespace adit::store
