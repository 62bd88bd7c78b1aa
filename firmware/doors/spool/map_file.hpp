#pragma once

#include <cstddef>
#include <string>

#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"
#include "icd/rules.hpp"
#include "icd/status.hpp"
#include "spool/part_file.hpp"

namespace adit::spool {

/// The file of a queued map, with the data first (codec::DataFirst). So data can be written as it arrives,
/// and then mapped instead of held in memory. Use from one thread at a time. Functions that return int give
/// errno, or 0.
class MapFile {
 public:
  /// `path`: prefix of the temporary name until finish().
  explicit MapFile(const std::string& path);

  /// Appends data and frees each chunk once it is written. After an error, `data` holds the rest.
  int append(icd::ChunkedBytes& data);
  /// The data that append() has written, mapped from the file. Empty with errno: it cannot be mapped.
  icd::ChunkedBytes stored();
  std::size_t stored_bytes() const;
  /// Whether `data` begins with all chunks that stored() gave.
  bool begins(const icd::ChunkedBytes& data) const;

  /// Writes the rest of `map`, renames the file to `path`, and replaces the map's data by the mapped file.
  /// Call only if begins(map.data.bytes), or if no data has been appended.
  int finish(icd::MapUpdate& map, const std::string& path);

  /// Reads a file that finish() made and maps its data unread; codec::check_data() checks the data. Errors:
  /// 503 if the file cannot be read, otherwise the file is damaged.
  static icd::Checked<icd::MapUpdate> read(const std::string& path, const icd::Rules& rules);

 private:
  PartFile file_;
  int error_;
  MappedFile shown_;  // from stored()
};

}  // namespace adit::spool
