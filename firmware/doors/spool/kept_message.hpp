#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "codec/field.hpp"
#include "icd/chunked_bytes.hpp"
#include "icd/grid_bounds.hpp"
#include "icd/mapping.hpp"
#include "icd/rules.hpp"
#include "icd/status.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::spool {

/// A file's bytes in memory, valid while `owner` lives. A mapped file on a tmpfs takes no memory of its own.
struct MappedFile {
  std::shared_ptr<const void> owner;
  std::span<const std::uint8_t> bytes;
};
/// The bytes of a file, or errno. A small file is copied, which is faster than a mapping.
std::expected<MappedFile, int> map_file(const std::string& path);
std::string_view text_in(const MappedFile& file);
/// The refusal for an unreadable file: 503, or 422 if it does not exist, because its content is lost.
icd::Refusal unreadable(const std::string& path, int error);

/// An unfinished file for this user alone. It has a temporary name until name(); the destructor removes a
/// file without its final name. Use from one thread at a time. Functions that return int give errno, or 0.
class PartFile {
 public:
  /// Ending of temporary names. A killed process leaves such files.
  static constexpr std::string_view kEnding = ".part";

  /// `path`: prefix of the unique temporary name.
  explicit PartFile(const std::string& path);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  std::size_t size() const { return size_; }
  /// Appends, and frees each chunk once it is written. After an error, `bytes` holds the rest.
  int append(icd::ChunkedBytes& bytes);
  int append(std::string_view bytes);
  /// Overwrites the beginning.
  int begin_with(std::string_view bytes) const { return write(bytes, 0); }
  std::expected<MappedFile, int> map() const;
  /// Renames the file to `path` and replaces an older file there.
  int name(const std::string& path);

 private:
  int write(std::string_view bytes, std::size_t place) const;

  std::string part_;
  loop::FileDescriptor fd_;
  int error_ = 0;  // from the constructor
  std::size_t size_ = 0;
  bool named_ = false;
};

/// The file of a queued map, with the data first (codec::DataFirst), so that data can be written as it
/// arrives and then mapped, not held in memory. Use from one thread at a time. An int result is errno, or 0.
class MapFile {
 public:
  /// `path`: prefix of the temporary name until finish().
  explicit MapFile(const std::string& path);

  /// Appends data and frees each chunk once it is written. After an error, `data` holds the rest.
  int append(icd::ChunkedBytes& data) { return error_ != 0 ? error_ : file_.append(data); }
  /// The data that append() has written, mapped from the file. Empty with errno: it cannot be mapped.
  icd::ChunkedBytes mapped_bytes();
  std::size_t stored_bytes() const;
  /// Whether `data` begins with all chunks that mapped_bytes() gave.
  bool is_prefix_of(const icd::ChunkedBytes& data) const;

  /// Writes the rest of `map`, renames the file to `path`, and replaces the map's data by the mapped file.
  /// Call only if is_prefix_of(map.data.bytes), or if no data has been appended.
  int finish(icd::MapUpdate& map, const std::string& path);

  /// Reads a file that finish() made and maps its data unread; codec::check_data() checks the data. Errors:
  /// 503 if the file cannot be read, otherwise the file is damaged.
  static icd::Checked<icd::MapUpdate> read(const std::string& path, const icd::Rules& rules);

 private:
  PartFile file_;
  int error_;
  MappedFile shown_;  // from mapped_bytes()
};

// Messages in files of their own, in the form of codec/write.hpp. The files survive a crash of the process,
// not of the machine, because they are not flushed.

/// Creates the directory, readable by this user alone. Errors show when a file is written into it.
void make_folder_of_ours(const std::string& folder);

/// Writes a file for this user alone, completely or not at all, and frees each chunk once it is written. An
/// error names the file and leaves an older file unchanged. Writer thread.
std::expected<void, std::string> replace_file(const std::string& path, icd::ChunkedBytes bytes);

/// Removes unfinished files of a killed process. No writer may be active in the directory.
void remove_parts(const std::string& folder);

/// Whether all files of a message directory can be read now. A missing directory counts as readable.
bool can_be_read(const std::string& folder);

/// Reads a message and checks it by the ICD's own rules. The team's rules (aliases, frames, sizes) were
/// applied when it arrived and may have changed. Errors: 503 if the file cannot be read, otherwise the file
/// is damaged. A map's data is not read (MapFile::read()).
icd::Checked<icd::MapUpdate> read_map(const std::string& path);
icd::Checked<icd::StateUpdate> read_state(const std::string& path);
icd::Checked<icd::MarkersUpdate> read_markers(const std::string& path);

/// A grid's bounds as a JSON list: left, bottom, lowest, right, top, highest, turned, along the grid's axes.
codec::Value to_json(const icd::GridBounds& bounds);
/// Reads them for `grid`. Bounds that are smaller than the grid are enlarged. Refuses damaged ones.
icd::GridBounds read_bounds(const codec::Field& field, const icd::OccupancyGrid& grid);

}  // namespace adit::spool
