#include "archive/run_folder.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <filesystem>
#include <system_error>
#include <utility>

#include "codec/row.hpp"
#include "host/disk.hpp"
#include "host/files.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/text.hpp"
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
  static_cast<void>(scan());  // append() looks again and returns the error
}

std::expected<void, std::string> GrowingFile::scan() {
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
  ADIT_TRY(scan());
  const bool fits = !files_.empty() && files_.back().size + bytes.size() <= largest;
  if (fits && !fd_) fd_ = loop::open_regular(path(files_.back().number), O_WRONLY | O_APPEND);
  if (!fits || !fd_) {
    constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC;
    const std::uint64_t number = files_.empty() ? 1 : files_.back().number + 1;
    loop::FileDescriptor next(::open(path(number).c_str(), kFlags, host::kOursAlone));
    if (!next) return std::unexpected(host::path_error(path(number), errno));
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
  return std::unexpected(host::path_error(path(last.number), error));
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

std::expected<RunFolder::WriteResult, std::string> RunFolder::write(const Batch& batch, std::uint64_t most) {
  if (const auto disk = host::disk_of(path_)) {  // otherwise the write fails with the reason
    if (disk->free < std::min(kLeave, disk->all / 4)) return std::unexpected("the disk is nearly full");
    most = std::min(most, (disk->free + bytes()) / 2);
  }
  ADIT_TRY(tiles_.shrink(most));
  ADIT_TRY(lines_.shrink(most / 8));
  const std::size_t largest = largest_file(most);
  WriteResult written;
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
        told.add_file(*bytes, prefix == kTiles ? number : 0);
      } else if (all_read) {
        all_read = std::unexpected(bytes.error());
      }
    }
  }
  return all_read;
}

std::expected<bool, std::string> is_blank(const std::string& folder) {
  bool is_blank = !host::can_exist(folder + '/' + RunFolder::kFacts);
  for (const char* prefix : {kLines, kTiles}) {
    const auto numbers = ADIT_TRY(host::numbers_in(folder, prefix));
    is_blank = is_blank && numbers.empty();
  }
  return is_blank;
}

namespace {

constexpr std::string_view kGone = "gone-";

/// Total size of the files, or why one of them or the directory cannot be read.
std::expected<std::uint64_t, std::string> bytes_in(const std::string& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  const auto listed = host::for_each_name(folder, [&](std::string_view name) {
    const auto size = fs::file_size(fs::path(folder) / name, error);
    if (!error) bytes += size;
    if (error == std::errc::no_such_file_or_directory || error == std::errc::is_a_directory) error.clear();
    return !error;
  });
  if (!listed) return std::unexpected(host::path_error(folder, listed.error()));
  if (error) return std::unexpected(folder + ": " + error.message());
  return bytes;
}

/// A run whose start the box does not know has `began` 0; then the Command Post decides, if known.
bool is_same(const Head& a, const Head& b) {
  if (a.run != b.run || std::abs(a.began - b.began) > 1) return false;
  return a.began > 0 || a.post.empty() || b.post.empty() || a.post == b.post;
}

}  // namespace

bool RunsFolder::is_key(std::string_view name) {
  constexpr std::size_t kLongest = 30;
  const auto dash = name.find('-');
  const auto number = name.substr(0, dash);
  const auto more = dash == std::string_view::npos ? "2" : name.substr(dash + 1);
  return name.size() <= kLongest && !number.empty() && !more.empty() &&
         std::ranges::all_of(number, icd::is_digit) && std::ranges::all_of(more, icd::is_digit);
}

std::expected<bool, std::string> RunsFolder::has(const std::string& key) const {
  if (!is_key(key)) return false;
  std::error_code error;
  const auto type = fs::status(folder_of(key), error).type();
  if (error && type != fs::file_type::not_found)
    return std::unexpected(folder_of(key) + ": " + error.message());
  return type == fs::file_type::directory;
}

std::expected<std::optional<api::RunRow>, std::string> RunsFolder::facts_of(const std::string& key) const {
  const bool exists = ADIT_TRY(has(key));
  if (!exists) return std::nullopt;
  const std::string folder = folder_of(key), file = folder + '/' + RunFolder::kFacts;
  std::optional<api::RunRow> row;
  std::expected<void, std::string> all_read;
  if (host::can_exist(file)) {
    const auto text = host::read_file(file);
    if (!text) {
      all_read = std::unexpected(text.error());
    } else if (auto read = codec::read_file<api::RunRow>(*text)) {
      row = std::move(*read);
    }
  }
  if (!row) {
    RunRecords told(0);
    const auto rest_read = read_run(folder, told, [&told] { return told.head().has_value(); });
    if (all_read) all_read = rest_read;
    if (!told.head() && !all_read) return std::unexpected(all_read.error());
    if (!told.head()) return std::nullopt;
    row = api::RunRow{
        .run = told.head()->run, .post = told.head()->post, .began = told.head()->began, .last = told.last()};
  }
  row->key = key;
  const auto bytes = ADIT_TRY(bytes_in(folder));
  row->bytes = bytes;
  row->is_present = false;
  return row;
}

std::expected<RunsFolder::List, std::string> RunsFolder::list() const {
  const auto names = host::names_in(path_, kMostRuns);
  if (!names) return std::unexpected(path_ + ": " + names.error());
  List list;
  for (const std::string& name : *names) {
    auto row = facts_of(name);
    if (!row) {
      list.unreadable = "cannot read a stored run: " + row.error();
      host::log(host::Level::Warning, "cannot read a stored run", {{"why", row.error()}});
    } else if (*row) {
      list.runs.push_back(**std::move(row));
    }
  }
  std::ranges::sort(list.runs, std::ranges::greater(),
                    [](const api::RunRow& row) { return std::pair(row.stamp.value_or(row.last), row.run); });
  return list;
}

std::expected<std::string, std::string> RunsFolder::begin(const Head& head) {
  std::error_code error;
  fs::create_directory(path_, error);
  fs::permissions(path_, fs::perms::owner_all, error);
  for (int more = 1; more < 1000; ++more) {
    std::string key = std::to_string(head.run) + (more == 1 ? "" : '-' + std::to_string(more));
    const bool exists = ADIT_TRY(has(key));
    if (!exists) {
      if (!fs::create_directory(folder_of(key), error)) break;
      fs::permissions(folder_of(key), fs::perms::owner_all, error);
      return key;
    }
    const auto facts = ADIT_TRY(facts_of(key));
    if (facts) {
      const api::RunRow& row = *facts;
      if (is_same(head, {.run = row.run, .began = row.began, .post = row.post})) return key;
      continue;
    }
    const auto is_new = ADIT_TRY(is_blank(folder_of(key)));
    if (is_new) return key;
  }
  return std::unexpected(path_ + ": " + (error ? error.message() : "cannot create a directory"));
}

std::expected<void, std::string> RunsFolder::remove(const std::string& key) {
  const bool exists = ADIT_TRY(has(key));
  if (!exists) return std::unexpected("there is no such run");
  const std::string gone = path_ + '/' + std::string(kGone) + key;
  std::error_code error;
  fs::rename(folder_of(key), gone, error);  // first, so that a crash does not leave half a run
  if (!error) fs::remove_all(gone, error);
  if (error) return std::unexpected(folder_of(key) + ": " + error.message());
  return {};
}

void RunsFolder::tidy(std::uint64_t most, const std::string& present) {
  const auto names = host::names_in(path_, kMostRuns);
  for (const std::string& name : names.value_or(std::vector<std::string>())) {
    std::error_code error;
    if (name.starts_with(kGone)) fs::remove_all(path_ + '/' + name, error);
  }
  const auto listed = list();
  if (!listed) return host::log(host::Level::Warning, "cannot delete old runs", {{"why", listed.error()}});
  const auto& rows = listed->runs;
  std::uint64_t all = 0;
  for (const api::RunRow& row : rows) all += row.bytes;
  if (const auto disk = host::disk_of(path_)) most = std::min(most, (disk->free + all) / 2);
  for (auto row = rows.rbegin(); row != rows.rend() && all > most; ++row) {
    if (row->key == present) continue;
    if (const auto removed = remove(row->key); !removed) {
      host::log(host::Level::Warning, "cannot delete an old run", {{"why", removed.error()}});
      continue;
    }
    all -= row->bytes;
    host::log(host::Level::Notice, "oldest run deleted to free space", {{"run", row->key}});
  }
}

}  // namespace adit::archive
