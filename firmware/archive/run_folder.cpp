#include "archive/run_folder.hpp"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <numeric>
#include <optional>
#include <utility>

#include "host/files.hpp"
#include "host/numbered_name.hpp"
#include "host/service.hpp"
#include "icd/require.hpp"
#include "loop/regular_file.hpp"

namespace adit::archive {
namespace {

namespace fs = std::filesystem;

constexpr const char *kTiles = "map-", *kLines = "lines-";
/// A file that host::read_file() reads.
constexpr std::size_t kLargest = std::size_t{900} << 10, kSmallest = std::size_t{96} << 10;

/// So that a sixteenth of the run goes with the first file.
std::size_t largest_file(std::uint64_t most) {
  return static_cast<std::size_t>(std::clamp<std::uint64_t>(most / 16, kSmallest, kLargest));
}

/// What the disk has, in bytes.
struct Disk {
  std::uint64_t all = 0, left = 0;
  bool is_short() const { return left < std::min(RunFolder::kLeave, all / 4); }
};
std::optional<Disk> disk_of(const std::string& folder) {
  struct statvfs disk{};
  if (statvfs(folder.c_str(), &disk) != 0) return std::nullopt;  // the write says what is wrong
  return Disk{std::uint64_t{disk.f_blocks} * disk.f_frsize, std::uint64_t{disk.f_bavail} * disk.f_frsize};
}

}  // namespace

GrowingFile::GrowingFile(std::string folder, std::string prefix, std::string head)
    : folder_(std::move(folder)), prefix_(std::move(prefix)), head_(std::move(head)) {
  static_cast<void>(look());  // append() looks again, and returns the error
}

std::expected<void, std::string> GrowingFile::look() {
  if (has_looked_) return {};
  auto numbers = host::numbers_in(folder_, prefix_);
  if (!numbers) return std::unexpected(std::move(numbers.error()));
  has_looked_ = true;
  numbers_ = std::move(*numbers);
  for (const std::uint64_t number : numbers_) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path(number), error);
    sizes_.push_back(error ? 0 : size);
  }
  return {};
}

std::string GrowingFile::path(std::uint64_t number) const {
  return folder_ + '/' + host::numbered_name(prefix_, number);
}

std::uint64_t GrowingFile::bytes() const {
  return std::accumulate(sizes_.begin(), sizes_.end(), std::uint64_t{0});
}

std::expected<void, std::string> GrowingFile::open_next() {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC;
  const std::uint64_t number = numbers_.empty() ? 1 : numbers_.back() + 1;
  loop::FileDescriptor next(::open(path(number).c_str(), kFlags, host::kOursAlone));
  if (!next) return std::unexpected(host::trouble(path(number), errno));
  file_ = std::move(next);
  numbers_.push_back(number);
  sizes_.push_back(0);
  const loop::FileDescriptor folder(::open(folder_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (!folder || ::fsync(folder.get()) != 0) return std::unexpected(host::trouble(folder_, errno));
  return {};
}

std::expected<void, std::string> GrowingFile::write(std::string_view bytes) {
  ssize_t count = -1;
  do {
    count = ::write(file_.get(), bytes.data(), bytes.size());
  } while (count < 0 && errno == EINTR);
  if (count == static_cast<ssize_t>(bytes.size())) {
    sizes_.back() += bytes.size();
    return {};
  }
  const int error = count < 0 ? errno : ENOSPC;
  if (count > 0) cut_back(sizes_.back());
  return std::unexpected(host::trouble(path(numbers_.back()), error));
}

void GrowingFile::cut_back(std::uint64_t size) {
  sizes_.back() = size;
  if (::ftruncate(file_.get(), static_cast<off_t>(size)) != 0) file_ = {};
}

std::expected<std::uint64_t, std::string> GrowingFile::append(std::string_view bytes, std::size_t largest) {
  if (auto looked = look(); !looked) return std::unexpected(std::move(looked.error()));
  const bool fits = !numbers_.empty() && sizes_.back() + bytes.size() <= largest;
  if (fits && !file_) {
    file_ = loop::open_regular(path(numbers_.back()), O_WRONLY | O_APPEND);
  }
  if (!fits || !file_) {
    if (const auto opened = open_next(); !opened) return std::unexpected(opened.error());
  }
  if (sizes_.back() == 0) {  // new, or a death left it so
    if (const auto begun = write(head_); !begun) return std::unexpected(begun.error());
  }
  if (const auto written = write(bytes); !written) return std::unexpected(written.error());
  if (::fdatasync(file_.get()) == 0) return numbers_.back();
  const int error = errno;
  cut_back(sizes_.back() - bytes.size());
  return std::unexpected(host::trouble(path(numbers_.back()), error));
}

void GrowingFile::remove_first() {
  if (numbers_.size() < 2 || !host::remove_file(path(numbers_.front()))) return;
  numbers_.erase(numbers_.begin());
  sizes_.erase(sizes_.begin());
}

RunFolder::RunFolder(std::string path, const Head& head)
    : path_(std::move(path)),
      tiles_(path_, kTiles, record_of(head)),
      lines_(path_, kLines, record_of(head)) {}

std::expected<RunFolder::Written, std::string> RunFolder::write(const Batch& batch, std::uint64_t most) {
  if (const auto disk = disk_of(path_)) {
    if (disk->is_short()) return std::unexpected("the disk is nearly full");
    most = std::min(most, (disk->left + bytes()) / 2);
  }
  while (tiles_.bytes() > most && tiles_.numbers().size() > 1) tiles_.remove_first();
  while (lines_.bytes() > most / 8 && lines_.numbers().size() > 1) lines_.remove_first();
  const std::size_t largest = largest_file(most);
  Written written;
  if (!batch.tiles.empty() || !batch.beside.empty()) {
    std::string records = batch.beside;
    for (const TileState& state : batch.tiles) records += record_of(state);
    const auto file = tiles_.append(records, largest);
    if (!file) return std::unexpected(file.error());
    written.file = *file;
  }
  if (!batch.facts.empty()) {
    const auto done = host::write_file(path_ + '/' + kFacts, batch.facts, host::kOursAlone);
    if (!done) return std::unexpected(done.error());
  }
  if (!batch.lines.empty()) {
    if (const auto done = lines_.append(batch.lines, largest); !done) return std::unexpected(done.error());
  }
  written.first_file = tiles_.numbers().size() > 1 ? tiles_.numbers().front() : 0;
  written.bytes = bytes();
  return written;
}

void RunFolder::remove_first(std::uint64_t file) {
  if (!tiles_.numbers().empty() && tiles_.numbers().front() == file) tiles_.remove_first();
}

std::expected<void, std::string> read_run(const std::string& folder, Told& told,
                                          const std::function<bool()>& enough) {
  std::expected<void, std::string> all_read;
  for (const char* prefix : {kLines, kTiles}) {
    const auto numbers = host::numbers_in(folder, prefix);
    if (!numbers) return std::unexpected(numbers.error());
    for (const std::uint64_t number : *numbers) {
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
    const auto numbers = host::numbers_in(folder, prefix);
    if (!numbers) return std::unexpected(numbers.error());
    is_blank = is_blank && numbers->empty();
  }
  return is_blank;
}

}  // namespace adit::archive
