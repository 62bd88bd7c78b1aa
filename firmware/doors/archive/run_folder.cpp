#include "archive/run_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <utility>

#include "host/disk.hpp"
#include "host/files.hpp"
#include "host/numbered_name.hpp"
#include "host/service.hpp"
#include "icd/require.hpp"
#include "icd/try.hpp"
#include "loop/regular_file.hpp"

namespace adit::archive {
namespace {

namespace fs = std::filesystem;

constexpr const char *kTiles = "map-", *kLines = "lines-";
/// File sizes that host::read_file() can read.
constexpr std::size_t kLargest = std::size_t{900} << 10, kSmallest = std::size_t{96} << 10;

/// A file holds a sixteenth of the run, which is lost with the first file.
std::size_t largest_file(std::uint64_t most) {
  return static_cast<std::size_t>(std::clamp<std::uint64_t>(most / 16, kSmallest, kLargest));
}

}  // namespace

GrowingFile::GrowingFile(std::string folder, std::string prefix, std::string head)
    : folder_(std::move(folder)), prefix_(std::move(prefix)), head_(std::move(head)) {
  static_cast<void>(look());  // append() looks again and returns the error
}

std::expected<void, std::string> GrowingFile::look() {
  if (has_looked_) return {};
  auto numbers = ADIT_TRY(host::numbers_in(folder_, prefix_));
  has_looked_ = true;
  for (const std::uint64_t number : numbers) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path(number), error);
    files_.push_back({number, error ? kLargest : size});  // unknown: nothing is added to it
  }
  return {};
}

std::string GrowingFile::path(std::uint64_t number) const {
  return folder_ + '/' + host::numbered_name(prefix_, number);
}

std::uint64_t GrowingFile::bytes() const {
  std::uint64_t bytes = 0;
  for (const File& file : files_) bytes += file.size;
  return bytes;
}

std::expected<std::uint64_t, std::string> GrowingFile::append(std::string_view bytes, std::size_t largest) {
  ADIT_TRY(look());
  const bool fits = !files_.empty() && files_.back().size + bytes.size() <= largest;
  if (fits && !fd_) fd_ = loop::open_regular(path(files_.back().number), O_WRONLY | O_APPEND);
  if (!fits || !fd_) {
    constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC;
    const std::uint64_t number = files_.empty() ? 1 : files_.back().number + 1;
    loop::FileDescriptor next(::open(path(number).c_str(), kFlags, host::kOursAlone));
    if (!next) return std::unexpected(host::trouble(path(number), errno));
    fd_ = std::move(next);
    files_.push_back({number, 0});
  }
  File& last = files_.back();
  const bool is_new = last.size == 0;  // new, or left empty by a crash
  const std::string all = (is_new ? head_ : "") + std::string(bytes);
  const bool is_written = loop::write_all(fd_.get(), all, last.size) == 0 && ::fdatasync(fd_.get()) == 0 &&
                          (!is_new || host::sync_folder(path(last.number)));
  if (is_written) {
    last.size += all.size();
    return last.number;
  }
  const int error = errno;
  if (::ftruncate(fd_.get(), static_cast<off_t>(last.size)) != 0) fd_ = {};
  return std::unexpected(host::trouble(path(last.number), error));
}

std::expected<void, std::string> GrowingFile::remove_first() {
  auto removed = host::remove_file(path(files_.front().number));
  if (removed) files_.erase(files_.begin());
  return removed;
}

std::expected<void, std::string> GrowingFile::shrink(std::uint64_t most) {
  while (bytes() > most && first() != 0) {
    if (auto removed = remove_first(); !removed) return removed;
  }
  return {};
}

RunFolder::RunFolder(std::string path, const Head& head)
    : path_(std::move(path)),
      tiles_(path_, kTiles, record_of(head)),
      lines_(path_, kLines, record_of(head)) {}

std::expected<RunFolder::Written, std::string> RunFolder::write(const Batch& batch, std::uint64_t most) {
  if (const auto disk = host::disk_of(path_)) {  // otherwise the write fails with the reason
    if (disk->free < std::min(kLeave, disk->all / 4)) return std::unexpected("the disk is nearly full");
    most = std::min(most, (disk->free + bytes()) / 2);
  }
  ADIT_TRY(tiles_.shrink(most));
  ADIT_TRY(lines_.shrink(most / 8));
  const std::size_t largest = largest_file(most);
  Written written;
  if (!batch.tiles.empty() || !batch.beside.empty()) {
    std::string records = batch.beside;
    for (const TileState& state : batch.tiles) records += record_of(state);
    const auto file = ADIT_TRY(tiles_.append(records, largest));
    written.file = file;
  }
  if (!batch.facts.empty()) {
    ADIT_TRY(host::write_file(path_ + '/' + kFacts, batch.facts, host::kOursAlone));
  }
  if (!batch.lines.empty()) {
    (void)ADIT_TRY(lines_.append(batch.lines, largest));
  }
  written.first_file = tiles_.first();
  written.bytes = bytes();
  return written;
}

void RunFolder::remove_first(std::uint64_t file) {
  if (tiles_.first() == file) (void)tiles_.remove_first();  // otherwise a later write removes it
}

std::expected<void, std::string> read_run(const std::string& folder, RunRecords& told,
                                          const std::function<bool()>& enough) {
  std::expected<void, std::string> all_read;
  for (const char* prefix : {kLines, kTiles}) {
    const auto numbers = ADIT_TRY(host::numbers_in(folder, prefix));
    for (const std::uint64_t number : numbers) {
      if (enough()) return all_read;
      if (const auto bytes = host::read_file(folder + '/' + host::numbered_name(prefix, number))) {
        told.tell(*bytes, prefix == kTiles ? number : 0);
      } else if (all_read) {
        all_read = std::unexpected(bytes.error());
      }
    }
  }
  return all_read;
}

std::expected<bool, std::string> is_blank(const std::string& folder) {
  bool is_blank = !host::may_exist(folder + '/' + RunFolder::kFacts);
  for (const char* prefix : {kLines, kTiles}) {
    const auto numbers = ADIT_TRY(host::numbers_in(folder, prefix));
    is_blank = is_blank && numbers.empty();
  }
  return is_blank;
}

}  // namespace adit::archive
