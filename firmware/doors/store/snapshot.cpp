#include "store/snapshot.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <vector>

#include "icd/try.hpp"
#include "store/scan.hpp"

namespace adit::store {

Result<Snapshot> Snapshot::begin(const Directory& directory, const Keeping& keeping, const Log& log) {
  const auto salt = ADIT_TRY(random_salt());
  Snapshot snapshot(directory, keeping);
  snapshot.name_ = {FileName::Kind::Snapshot, log.number(), salt};
  snapshot.process_ = log.process();
  snapshot.base_ = log.last();
  const std::string part = snapshot.name_.text() + std::string(Directory::kPart);
  auto made = ADIT_TRY(directory.make(part));
  snapshot.file_ = std::move(made);
  snapshot.part_ = part;
  const FileHeader header{.number = log.number(), .salt = salt, .base = log.last()};
  ADIT_TRY(snapshot.write(kFileBegins, 0, header.written()));
  return snapshot;
}

Snapshot::~Snapshot() {
  if (file_) (void)directory_->remove(part_);
}

Result<void> Snapshot::add(std::uint8_t kind, std::string_view body) {
  if (body.size() > kMostBody)
    return std::unexpected(
        Error{Error::Cause::TooLong, "a record of " + std::to_string(body.size()) + " bytes"});
  return write(kind, ++count_, body);
}

Result<void> Snapshot::write(std::uint8_t kind, std::uint64_t sequence, std::string_view body) {
  const std::string bytes =
      written({kind, sequence, process_, base_, body}, snapshot_layout(keeping_.layout), name_.salt, at_);
  if (at_ + bytes.size() > keeping_.most_bytes)
    return std::unexpected(Error{
        Error::Cause::TooLong, "a snapshot of more than " + std::to_string(keeping_.most_bytes) + " bytes"});
  if (const int error = write_all(file_.get(), bytes, at_); error != 0)
    return directory_->trouble(part_, error);
  at_ += (bytes.size() + 7) / 8 * 8;
  return {};
}

Result<void> Snapshot::finish() {
  if (auto wrote = write(kSnapshotEnds, ++count_, {}); !wrote) return wrote;
  if (keeping_.syncs && ::fsync(file_.get()) != 0) return directory_->trouble(part_, errno);
  const auto bytes = ADIT_TRY(directory_->read(part_, keeping_.most_bytes));
  const Scan read = scan(name_, bytes, snapshot_layout(keeping_.layout));
  if (!is_whole_snapshot(read) || read.frames.size() != count_) return directory_->trouble(part_, EIO);
  if (auto named = directory_->rename(part_, name_.text()); !named) return named;
  file_ = {};
  if (keeping_.syncs) {
    if (auto synced = directory_->sync(); !synced) return synced;
  }
  return remove_old();
}

Result<void> Snapshot::remove_old() const {
  const auto files = ADIT_TRY(directory_->files());
  std::vector<std::uint64_t> snapshots;
  for (const FileName& file : files) {
    if (file.kind == FileName::Kind::Snapshot) snapshots.push_back(file.number);
  }
  const std::size_t kept = keeping_.syncs ? 2 : 1;
  if (snapshots.size() < kept) return {};
  const std::uint64_t oldest = snapshots[snapshots.size() - kept];
  for (const FileName& file : files) {
    if (file.kind == FileName::Kind::Spare || file.number >= oldest) continue;
    if (auto removed = directory_->remove(file.text()); !removed) return removed;
  }
  return {};
}

}  // namespace adit::store
