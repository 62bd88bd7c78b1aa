#include "store/log.hpp"

#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <utility>
#include <vector>

#include "icd/try.hpp"
#include "store/contents.hpp"

namespace adit::store {
namespace {

constexpr std::size_t kLeftFree = 256u << 10;  // bytes of the disk, for small files such as settings
constexpr std::size_t kPiece = 256u << 10;     // bytes of zeros for one sync, so that others wait briefly

/// Writes `size` zeros to a new file and syncs them, if that leaves kLeftFree. Returns 0 or errno.
int write_zeros(int fd, std::size_t size, const std::atomic<bool>& enough) {
  struct statvfs disk{};
  if (::fstatvfs(fd, &disk) == 0 && std::uint64_t{disk.f_bavail} * disk.f_frsize < size + kLeftFree)
    return ENOSPC;
  const std::string zeros(std::min(size, kPiece), '\0');
  for (std::size_t at = 0; at < size; at += zeros.size()) {
    if (enough) return ECANCELED;
    const std::size_t count = std::min(zeros.size(), size - at);
    if (const int error = write_all(fd, std::string_view(zeros).substr(0, count), at); error != 0)
      return error;
    if (::fsync(fd) != 0) return errno;
  }
  return 0;
}

/// Creates a file of `size` zeros, which gets its name once they are synced.
Result<void> make_zeros(const Directory& directory, const FileName& name, std::size_t size,
                        const std::atomic<bool>& enough) {
  const std::string part = name.text() + std::string(Directory::kPart);
  const auto file = ADIT_TRY(directory.make(part));
  const int error = write_zeros(file.get(), size, enough);
  Result<void> made = error == 0 ? directory.rename(part, name.text()) : directory.file_error(error);
  if (!made) (void)directory.remove(part);
  return made;
}

std::unexpected<Error> too_long(std::string_view body) {
  return std::unexpected(
      Error{Error::Cause::TooLong, "a record of " + std::to_string(body.size()) + " bytes"});
}

}  // namespace

Result<void> Log::start(const Contents& contents) {
  last_ = contents.last;
  durable_ = contents.durable;
  process_ = contents.process + 1;
  highest_ = contents.number;
  for (const Contents::Rewrite& each : contents.rewrites) {
    if (each.frame.sequence > durable_) unsynced_.push_back({each.frame.kind, std::string(each.frame.body)});
  }
  if (auto removed = directory_.remove_parts(); !removed) return removed;
  if (keeping_.syncs) {  // an earlier process may have created it and ended
    if (auto synced = directory_.sync_name(); !synced) return synced;
  }
  if (!contents.log) return {};
  auto fd = ADIT_TRY(directory_.open_to_write(contents.log->text()));
  const std::size_t size = keeping_.syncs ? contents.size : keeping_.most_bytes;
  file_ = {*contents.log, std::move(fd), contents.end, std::max(size, contents.end)};
  if (auto rewritten = rewrite(contents); !rewritten) return rewritten;
  is_dead_ = false;
  durable_ = last_;
  unsynced_.clear();
  return {};
}

/// After a failed sync in an earlier process, pages may read well without being on disk. They are written
/// again, so that a successful sync means they are on disk.
Result<void> Log::rewrite(const Contents& contents) {
  std::map<std::string, loop::FileDescriptor> files;
  for (const Contents::Rewrite& each : contents.rewrites) {
    const std::string name = each.file.text();
    auto& fd = files[name];
    if (!fd) {
      auto opened = ADIT_TRY(directory_.open_to_write(name));
      fd = std::move(opened);
    }
    const std::string frame = to_bytes(each.frame, keeping_.layout, each.file.salt, each.offset);
    if (const int error = write_all(fd.get(), frame, each.offset); error != 0)
      return directory_.file_error(name, error);
  }
  if (!keeping_.syncs) return {};
  for (const auto& [name, fd] : files) {
    if (::fdatasync(fd.get()) != 0) return directory_.file_error(name, errno);
  }
  return directory_.sync();
}

Result<void> Log::append(std::uint8_t kind, std::string_view body, Durability durability) {
  if (body.size() > kMostBody) return too_long(body);
  if (room() < bytes_of(body.size())) {
    if (auto turned = turn_for(body.size()); !turned) return turned;
  }
  if (auto wrote = write(file_, {kind, last_ + 1, process_, durable_, body}); !wrote) {
    is_dead_ = keeping_.syncs;  // in memory the next frame replaces it
    return wrote;
  }
  const bool is_durable = !keeping_.syncs || durability == Durability::Now;
  if (is_durable) {
    if (auto synced = sync(); !synced) return synced;
  }
  ++last_;
  if (is_durable) {
    durable_ = last_;
    unsynced_.clear();
  } else {
    unsynced_.push_back({kind, std::string(body)});
  }
  return {};
}

Result<void> Log::flush() {
  if (unsynced_.empty()) return {};
  if (is_dead_) return turn();
  if (auto synced = sync(); !synced) return synced;
  durable_ = last_;
  unsynced_.clear();
  return {};
}

/// Starts the next file. The old file is synced, or its records above durable_ are void: the new header says
/// so, and the accepted ones follow it.
Result<void> Log::turn_for(std::size_t body) {
  if (!is_dead_) (void)flush();  // after an error is_dead_ is set
  std::size_t size = bytes_of(FileHeader().to_bytes().size()) + bytes_of(body);
  for (const UnsyncedRecord& each : unsynced_) size += bytes_of(each.body.size());
  ++highest_;
  auto made = make_file(keeping_.syncs ? std::max(size, keeping_.file_bytes) : 0);
  const std::size_t small = size + keeping_.least_bytes;
  if (!made && made.error().cause == Error::Cause::Full && small < keeping_.file_bytes)
    made = make_file(small);
  auto next = ADIT_TRY(std::move(made));
  if (auto filled = fill(next); !filled) {
    (void)directory_.remove(next.name.text());  // if that fails, a later file's header says the same
    return filled;
  }
  file_ = std::move(next);
  is_dead_ = false;
  durable_ = last_;
  unsynced_.clear();
  return {};
}

/// A file with synced zeros and name.
Result<Log::File> Log::make_file(std::size_t size) const {
  const auto salt = ADIT_TRY(random_salt());
  File file{.name = {FileName::Kind::Log, highest_, salt}, .size = size};
  if (!keeping_.syncs) {
    auto made = ADIT_TRY(directory_.make(file.name.text()));
    file.fd = std::move(made);
    file.size = keeping_.most_bytes;
    return file;
  }
  const auto files = ADIT_TRY(directory_.files());
  const auto spare = std::ranges::find(files, FileName::Kind::Spare, &FileName::kind);
  Result<void> made;
  if (spare != files.end() && directory_.size(spare->text()) == size) {
    file.name.salt = spare->salt;
    made = directory_.rename(spare->text(), file.name.text());
  } else {
    made = make_zeros(directory_, file.name, size, false);
  }
  if (made) made = directory_.sync();
  auto fd = made ? directory_.open_to_write(file.name.text()) : std::unexpected(made.error());
  if (!fd) {
    (void)directory_.remove(file.name.text());  // the next try makes another one
    return std::unexpected(fd.error());
  }
  file.fd = std::move(*fd);
  return file;
}

Result<void> Log::fill(File& file) const {
  const std::string header = FileHeader{.number = file.name.number,
                                        .salt = file.name.salt,
                                        .base = durable_,
                                        .size = keeping_.syncs ? file.size : 0}
                                 .to_bytes();
  std::uint64_t sequence = durable_;
  auto wrote = write(file, {kFileBegins, 0, process_, durable_, header});
  for (const UnsyncedRecord& each : unsynced_) {
    if (wrote) wrote = write(file, {each.kind, ++sequence, process_, durable_, each.body});
  }
  if (wrote && keeping_.syncs && ::fdatasync(file.fd.get()) != 0) return directory_.file_error(errno);
  return wrote;
}

Result<void> Log::write(File& file, const Frame& frame) const {
  const std::string bytes = to_bytes(frame, keeping_.layout, file.name.salt, file.at);
  if (const int error = write_all(file.fd.get(), bytes, file.at); error != 0)
    return directory_.file_error(error);
  file.at += bytes_of(frame.body.size());
  return {};
}

Result<void> Log::sync() {
  if (!keeping_.syncs || ::fdatasync(file_.fd.get()) == 0) return {};
  is_dead_ = true;
  return directory_.file_error(errno);
}

Result<void> make_spare(const Directory& directory, const LogOptions& keeping,
                        const std::atomic<bool>& enough) {
  const auto files = ADIT_TRY(directory.files());
  const auto salt = ADIT_TRY(random_salt());
  if (std::ranges::find(files, FileName::Kind::Spare, &FileName::kind) != files.end()) return {};
  return make_zeros(directory, {FileName::Kind::Spare, 0, salt}, keeping.file_bytes, enough);
}

Result<Snapshot> Snapshot::begin(const Directory& directory, const LogOptions& keeping, const Log& log) {
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
  ADIT_TRY(snapshot.write(kFileBegins, 0, header.to_bytes()));
  return snapshot;
}

Snapshot::~Snapshot() {
  if (file_) (void)directory_->remove(part_);
}

Result<void> Snapshot::add(std::uint8_t kind, std::string_view body) {
  if (body.size() > kMostBody) return too_long(body);
  return write(kind, ++count_, body);
}

Result<void> Snapshot::write(std::uint8_t kind, std::uint64_t sequence, std::string_view body) {
  const std::string bytes =
      to_bytes({kind, sequence, process_, base_, body}, snapshot_layout(keeping_.layout), name_.salt, at_);
  if (at_ + bytes.size() > keeping_.most_bytes)
    return std::unexpected(Error{
        Error::Cause::TooLong, "a snapshot of more than " + std::to_string(keeping_.most_bytes) + " bytes"});
  if (const int error = write_all(file_.get(), bytes, at_); error != 0)
    return directory_->file_error(part_, error);
  at_ += (bytes.size() + 7) / 8 * 8;
  return {};
}

Result<void> Snapshot::finish() {
  if (auto wrote = write(kSnapshotEnds, ++count_, {}); !wrote) return wrote;
  if (keeping_.syncs && ::fsync(file_.get()) != 0) return directory_->file_error(part_, errno);
  const auto bytes = ADIT_TRY(directory_->read(part_, keeping_.most_bytes));
  const Scan read = scan(name_, bytes, snapshot_layout(keeping_.layout));
  if (!is_whole_snapshot(read) || read.frames.size() != count_) return directory_->file_error(part_, EIO);
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
