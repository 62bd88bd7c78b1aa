#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace adit::ledger {

/// Pages of the ledger, in its file and in its log's frames, are of this size.
inline constexpr std::size_t kPage = 4096;
/// SQLite's write-ahead log: a header, then frames, each with a header and a page.
inline constexpr std::size_t kLogHeader = 32;
inline constexpr std::size_t kFrameHeader = 24;
inline constexpr std::size_t kFrame = kFrameHeader + kPage;

/// A log as it lies on the disk, judged before SQLite sees it: SQLite stops at the first frame whose checksum
/// fails and forgets the rest without a word.
///
/// Each frame's checksum goes on from the one before, and is kept in the frame: so frames after a bad one can
/// be told from what is left of an earlier round, and where one byte of a frame is bad its checksum says
/// which, and what it was.
struct LogReading {
  /// Bytes to put right, and then SQLite reads the log as it was written.
  struct Repair {
    std::size_t at = 0;
    char byte = 0;
  };
  std::vector<Repair> repairs;
  /// Why what the log held cannot all be had, or "". A last transaction that is not whole is no damage where
  /// nothing follows it but one more: a power cut leaves what was not flushed like that.
  std::string damage;
  bool ended = true;  // the end of what was written last is to be seen in it
  bool empty = true;  // it holds nothing
};

/// `log` with the repairs made.
LogReading read_log(std::string& log);

}  // namespace adit::ledger
