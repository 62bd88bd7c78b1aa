#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"
#include "store/log.hpp"

namespace adit::store {

/// Writes a file that stands for all records before a log's number. It has its name once it is whole; until
/// then, and if it never comes to that, nothing has changed. For one thread at a time, beside the Log.
class Snapshot {
 public:
  /// `log`: has just turned. `directory` outlives this.
  static Result<Snapshot> begin(const Directory& directory, const Keeping& keeping, const Log& log);
  Snapshot(Snapshot&&) = default;
  Snapshot& operator=(Snapshot&&) = delete;
  ~Snapshot();

  Result<void> add(std::uint8_t kind, std::string_view body);
  /// Syncs it, reads it back, names it. Then files go that neither it nor the snapshot before it needs; in
  /// memory that one goes, too.
  Result<void> finish();
  std::size_t bytes() const { return at_; }

 private:
  Snapshot(const Directory& directory, const Keeping& keeping) : directory_(&directory), keeping_(keeping) {}
  Result<void> write(std::uint8_t kind, std::uint64_t sequence, std::string_view body);
  Result<void> remove_old() const;

  const Directory* directory_;
  Keeping keeping_;
  FileName name_;
  std::string part_;
  loop::FileDescriptor file_;
  std::uint64_t process_ = 0, base_ = 0, count_ = 0;
  std::size_t at_ = 0;
};

}  // namespace adit::store
