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
  numbers_ = host::numbers_in(folder_, prefix_);
  for (const std::uint64_t number : numbers_) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path(number), error);
    sizes_.push_back(error ? 0 : size);
  }
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
  return write(head_);
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
  if (count > 0 && ::ftruncate(file_.get(), static_cast<off_t>(sizes_.back())) != 0) file_ = {};
  return std::unexpected(host::trouble(path(numbers_.back()), error));
}

std::expected<std::uint64_t, std::string> GrowingFile::append(std::string_view bytes, std::size_t largest) {
  const bool fits = !numbers_.empty() && sizes_.back() + bytes.size() <= largest;
  if (fits && !file_) {
    file_ = loop::FileDescriptor(::open(path(numbers_.back()).c_str(), O_WRONLY | O_APPEND | O_CLOEXEC));
  }
  if (!fits || !file_) {
    if (const auto opened = open_next(); !opened) return std::unexpected(opened.error());
  }
  if (const auto written = write(bytes); !written) return std::unexpected(written.error());
  if (::fdatasync(file_.get()) != 0) return std::unexpected(host::trouble(path(numbers_.back()), errno));
  return numbers_.back();
}

void GrowingFile::remove_first() {
  if (numbers_.size() < 2 || !host::remove_file(path(numbers_.front()))) return;
  numbers_.erase(numbers_.begin());
  sizes_.erase(sizes_.begin());
}

RunFolder::RunFolder(std::string path, const Head& head)
    : path_(std::move(path)),
      tiles_(path_, kTiles, framed(Kind::Head, said(head))),
      lines_(path_, kLines, framed(Kind::Head, said(head))) {}

std::expected<RunFolder::Written, std::string> RunFolder::write(const Batch& batch, std::uint64_t most) {
  if (const auto disk = disk_of(path_)) {
    if (disk->is_short()) return std::unexpected("the disk is nearly full");
    most = std::min(most, (disk->left + bytes()) / 2);
  }
  while (tiles_.bytes() > most && tiles_.numbers().size() > 1) tiles_.remove_first();
  while (lines_.bytes() > most / 8 && lines_.numbers().size() > 1) lines_.remove_first();
  const std::size_t largest = largest_file(most);
  Written written;
  if (!batch.lines.empty()) {
    if (const auto done = lines_.append(batch.lines, largest); !done) return std::unexpected(done.error());
  }
  if (!batch.tiles.empty() || !batch.beside.empty()) {
    std::string records = batch.beside;
    for (const TileState& state : batch.tiles) records += framed(Kind::Tile, said(state));
    const auto file = tiles_.append(records, largest);
    if (!file) return std::unexpected(file.error());
    written.file = *file;
  }
  if (!batch.facts.empty()) {
    const auto done = host::write_file(path_ + '/' + kFacts, batch.facts, host::kOursAlone);
    if (!done) return std::unexpected(done.error());
  }
  written.first_file = tiles_.numbers().size() > 1 ? tiles_.numbers().front() : 0;
  written.bytes = bytes();
  return written;
}

void RunFolder::remove_first(std::uint64_t file) {
  if (!tiles_.numbers().empty() && tiles_.numbers().front() == file) tiles_.remove_first();
}

void read_run(const std::string& folder, Told& told, const std::function<bool()>& enough) {
  for (const char* prefix : {kLines, kTiles}) {
    for (const std::uint64_t number : host::numbers_in(folder, prefix)) {
      if (enough()) return;
      if (const auto bytes = host::read_file(folder + '/' + host::numbered_name(prefix, number)))
        told.tell(*bytes, prefix == kTiles ? number : 0);
    }
  }
}

}  // namespace adit::archive
