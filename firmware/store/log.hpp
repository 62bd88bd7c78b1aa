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
  Now,   // it survives a power cut once append() has returned
  Soon,  // it survives a kill, and a power cut after the next append with Now, or flush()
};

/// Appends records to a log (README.md). For one thread at a time. An append that has failed may succeed
/// later.
class Log {
 public:
  /// `directory` outlives this.
  Log(const Directory& directory, const Keeping& keeping) : directory_(directory), keeping_(keeping) {}

  /// Before all else: goes on behind `contents`. What may be in memory alone is written again and synced. An
  /// error: what contents.durable does not cover is not known to be on the disk until an append succeeds.
  Result<void> start(const Contents& contents);

  /// Appends one record, all or nothing. `kind`: 1 to 126, with or without kMustUnderstand. After an error
  /// the record is void, but a process that starts before the next append may find it.
  Result<void> append(std::uint8_t kind, std::string_view body, Durability durability);
  /// Syncs what was appended with Soon.
  Result<void> flush();
  /// Begins the next file. A snapshot of its number can then stand for all before.
  Result<void> turn();

  std::uint64_t number() const { return file_.name.number; }  // of the file that is written
  std::uint64_t last() const { return last_; }                // sequence number
  std::uint64_t process() const { return process_; }
  /// Bytes of the file that are left.
  std::size_t room() const { return is_dead_ ? 0 : file_.size - file_.at; }
  /// Bytes that a record takes of it.
  std::size_t bytes_of(std::size_t body) const {
    return keeping_.layout.copies * room_of(body, keeping_.layout);
  }

 private:
  struct File {
    FileName name;
    loop::FileDescriptor fd = {};
    std::size_t at = 0, size = 0;  // where the next frame goes, and the end
  };
  struct Unsynced {
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
  const Keeping keeping_;
  File file_;
  std::uint64_t last_ = 0, durable_ = 0, process_ = 0;
  std::uint64_t highest_ = 0;       // number of a file that was tried
  std::vector<Unsynced> unsynced_;  // the records behind durable_
  /// No file, or a sync of it has failed: the kernel may have dropped what was written. The next one is
  /// begun.
  bool is_dead_ = true;
};

/// Makes a file of zeros that the next turn of a log takes: it needs no room then, and little time. Waits for
/// the disk; for another thread. Nothing if there is one, or once `enough` is true.
Result<void> make_spare(const Directory& directory, const Keeping& keeping, const std::atomic<bool>& enough);

}  // namespace adit::store
