#pragma once

#include <cstddef>
#include <string>

#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"
#include "icd/rules.hpp"
#include "icd/status.hpp"
#include "spool/part_file.hpp"

namespace adit::spool {

/// The file of a map that waits: its message with the data first (codec::DataFirst), so that the data can be
/// written as it arrives, and shown in the file rather than beside it. For one thread at a time. What fails
/// gives the errno, else 0.
class MapFile {
 public:
  /// `path`: what it is named after until it has its name.
  explicit MapFile(const std::string& path);

  /// Puts data at the end; each chunk is freed as it is written. Where it fails, `data` is what is left.
  int append(icd::ChunkedBytes& data);
  /// What append() has put there, in the file. Empty with errno: it cannot be read.
  icd::ChunkedBytes stored();
  std::size_t stored_bytes() const;
  /// Whether `data` begins with what stored() gave, all of it.
  bool begins(const icd::ChunkedBytes& data) const;

  /// Writes what is missing of `map`, whose data begins so, gives it its name, and shows its data in it.
  int finish(icd::MapUpdate& map, const std::string& path);

  /// The map in a file that finish() made, with its data in the file, which is not read: what it is worth is
  /// to be found out by codec::check_data(). Refused with 503 if the file cannot be read, else because it is
  /// damaged.
  static icd::Checked<icd::MapUpdate> read(const std::string& path, const icd::Rules& rules);

 private:
  PartFile file_;
  int error_;
  MappedFile shown_;  // by stored()
};

}  // namespace adit::spool
