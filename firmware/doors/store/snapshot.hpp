#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"
#include "store/log.hpp"

namespace adit::store {

/// Writes a snapshot, which replaces all records before a log's number. The file gets its name when it is
/// complete; an unfinished one has no effect. Use from one thread at a time, which may run beside the Log's.
class Snapshot {
 public:
  /// `log` must have just turned. `directory` must outlive this object.
  static Result<Snapshot> begin(const Directory& directory, const Keeping& keeping, const Log& log);
  Snapshot(Snapshot&&) = default;
  Snapshot& operator=(Snapshot&&) = delete;
  ~Snapshot();

  Result<void> add(std::uint8_t kind, std::string_view body);
  /// Syncs, verifies and names the file. Then removes files that neither it nor the previous snapshot needs,
  /// and in memory also that snapshot.
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
