#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "loop/file_descriptor.hpp"
#include "store/contents.hpp"
#include "store/directory.hpp"
#include "store/frame.hpp"

namespace adit::store {

enum class Durability : std::uint8_t {
  Now,   // survives a power cut when append() returns
  Soon,  // survives a kill; survives a power cut after the next append with Now, or flush()
};

/// Appends records to a log (README.md). Use from one thread at a time. After a failed append, later ones may
/// succeed.
class Log {
 public:
  /// `directory` must outlive this object.
  Log(const Directory& directory, const LogOptions& keeping) : directory_(directory), keeping_(keeping) {}

  /// Call first. Continues after `contents`. Writes and syncs possibly unsynced data again. Error: data
  /// beyond contents.durable may not be on disk until an append succeeds.
  Result<void> start(const Contents& contents);

  /// Appends one record, all or nothing. `kind`: 1 to 126, with or without kMustUnderstand. After an error
  /// the record is void, but a process that starts before the next append may find it.
  Result<void> append(std::uint8_t kind, std::string_view body, Durability durability);
  /// Syncs records appended with Soon.
  Result<void> flush();
  /// Starts the next file. A snapshot with its number can then replace all earlier files.
  Result<void> turn() { return turn_for(0); }

  std::uint64_t number() const { return file_.name.number; }  // of the present file
  std::uint64_t last() const { return last_; }                // last sequence number
  std::uint64_t durable() const { return durable_; }          // of the last record that is synced
  std::uint64_t process() const { return process_; }
  /// Bytes left in the file.
  std::size_t room() const { return is_dead_ ? 0 : file_.size - file_.at; }
  /// Bytes that a record needs in it.
  std::size_t bytes_of(std::size_t body) const {
    return keeping_.layout.copies * room_of(body, keeping_.layout);
  }

 private:
  struct File {
    FileName name;
    loop::FileDescriptor fd = {};
    std::size_t at = 0, size = 0;  // offset of the next frame, and the end
  };
  struct UnsyncedRecord {
    std::uint8_t kind;
    std::string body;
  };
  Result<void> write(File& file, const Frame& frame) const;
  Result<void> sync();
  Result<void> rewrite(const Contents& contents);
  Result<void> turn_for(std::size_t body);
  Result<File> make_file(std::size_t size) const;
  Result<void> fill(File& file) const;

  const Directory& directory_;
  const LogOptions keeping_;
  File file_;
  std::uint64_t last_ = 0, durable_ = 0, process_ = 0;
  std::uint64_t highest_ = 0;             // highest tried file number
  std::vector<UnsyncedRecord> unsynced_;  // records above durable_
  /// No file, or a sync failed and the kernel may have dropped data. The next append starts a new file.
  bool is_dead_ = true;
};

/// Creates a file of zeros for the next turn(), which then needs no space and little time. Blocks on the
/// disk; use another thread. No effect if there is one, or once `enough` is true.
Result<void> make_spare(const Directory& directory, const LogOptions& keeping,
                        const std::atomic<bool>& enough);

/// Writes a snapshot, which replaces all records before a log's number. The file gets its name when it is
/// complete; an unfinished one has no effect. Use from one thread at a time, which may run beside the Log's.
class Snapshot {
 public:
  /// `log` must have just turned. `directory` must outlive this object.
  static Result<Snapshot> begin(const Directory& directory, const LogOptions& keeping, const Log& log);
  Snapshot(Snapshot&&) = default;
  Snapshot& operator=(Snapshot&&) = delete;
  ~Snapshot();

  Result<void> add(std::uint8_t kind, std::string_view body);
  /// Syncs, verifies and names the file. Then removes files that neither it nor the previous snapshot needs,
  /// and in memory also that snapshot.
  Result<void> finish();
  std::size_t bytes() const { return at_; }

 private:
  Snapshot(const Directory& directory, const LogOptions& keeping)
      : directory_(&directory), keeping_(keeping) {}
  Result<void> write(std::uint8_t kind, std::uint64_t sequence, std::string_view body);
  Result<void> remove_old() const;

  const Directory* directory_;
  LogOptions keeping_;
  FileName name_;
  std::string part_;
  loop::FileDescriptor file_;
  std::uint64_t process_ = 0, base_ = 0, count_ = 0;
  std::size_t at_ = 0;
};

}  // namespace adit::store
