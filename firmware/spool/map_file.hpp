#pragma once

#include <cstddef>
#include <string>

#include "icd/chunked_bytes.hpp"
#include "icd/map_update.hpp"
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

  /// `map`, which was read from that file, is shown with its data in it, if the file is as finish() makes it.
  static void show(icd::MapUpdate& map, const std::string& path);

 private:
  PartFile file_;
  int error_;
  MappedFile shown_;  // by stored()
};

}  // namespace adit::spool
