#include "host/files.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <libdeflate.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <system_error>

#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "loop/regular_file.hpp"

namespace adit::host {
namespace {

using loop::FileDescriptor;

std::string folder_of(const std::string& path) {
  const auto slash = path.rfind('/');
  if (slash == std::string::npos) return ".";
  return slash == 0 ? "/" : path.substr(0, slash);
}

constexpr const char* kBeingWritten = ".writing";

/// A new file for this user alone. Replaces a file of that name that an earlier process left.
FileDescriptor make_new(const std::string& path) {
  constexpr int kFlags = O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC;
  FileDescriptor fd(open(path.c_str(), kFlags, kOursAlone));
  if (fd || errno != EEXIST || unlink(path.c_str()) != 0) return fd;
  return FileDescriptor(open(path.c_str(), kFlags, kOursAlone));
}

constexpr const char* kChecksum = "crc32 ";

/// The last line of a file by write_kept().
std::string checksum_of(const std::string& text) {
  std::array<char, 32> line;
  (void)std::snprintf(line.data(), line.size(), "%s%08" PRIx32 "\n", kChecksum,
                      libdeflate_crc32(0, text.data(), text.size()));
  return line.data();
}

bool fill(int fd, const std::string& text, int mode) {
  return fchmod(fd, static_cast<mode_t>(mode)) == 0 && loop::write_all(fd, text, 0) == 0 && fsync(fd) == 0;
}

}  // namespace

std::string path_error(const std::string& path, int error) {
  return path + ": " + loop::text_of(error);
}

bool sync_folder(const std::string& path) {
  const FileDescriptor folder(open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  return folder && fsync(folder.get()) == 0;
}

std::expected<File, int> slurp(const std::string& path, std::size_t most) {
  const FileDescriptor fd = loop::open_regular(path, O_RDONLY);
  File file{};
  if (!fd || fstat(fd.get(), &file.status) != 0) return std::unexpected(errno);
  auto text = ADIT_TRY(loop::read_all(fd, most));
  file.text = std::move(text);
  return file;
}

bool can_exist(const std::string& path) {
  std::error_code unknown;
  return std::filesystem::exists(path, unknown) || unknown;
}

void set_damaged_aside(const std::string& path, std::string_view what, const std::string& why) {
  log(Level::Error, std::string(what) + " is damaged; its file is renamed", {{"file", path}, {"why", why}});
  namespace fs = std::filesystem;
  std::error_code error;
  fs::remove_all(path + kDamaged, error);
  if (!error) fs::rename(path, path + kDamaged, error);
  if (error && error != std::errc::no_such_file_or_directory)
    log(Level::Error, "cannot rename a damaged file", {{"file", path}, {"why", error.message()}});
}

std::expected<std::string, std::string> read_file(const std::string& path) {
  auto file = slurp(path);
  if (!file) return std::unexpected(path_error(path, file.error()));
  return strip_checksum(std::move(file->text));
}

std::string strip_checksum(std::string text) {
  const std::size_t line = text.rfind(kChecksum);
  if (line != std::string::npos && text.substr(line) == checksum_of(text.substr(0, line))) text.resize(line);
  return text;
}

std::expected<void, std::string> write_file(const std::string& path, const std::string& text, int mode) {
  const std::string temporary = path + kBeingWritten;
  const FileDescriptor fd = make_new(temporary);
  if (!fd) return std::unexpected(path_error(path, errno));
  if (!fill(fd.get(), text, mode) || rename(temporary.c_str(), path.c_str()) != 0) {
    const int error = errno;
    unlink(temporary.c_str());
    return std::unexpected(path_error(path, error));
  }
  if (!sync_folder(path)) return std::unexpected(path_error(folder_of(path), errno));
  return {};
}

std::expected<void, std::string> write_kept(const std::string& path, const std::string& text) {
  const std::string whole = text + checksum_of(text);
  ADIT_TRY(write_file(path + kCopy, whole, kOursAlone));
  return write_file(path, whole, kOursAlone);
}

void keep_copy(const std::string& path) {
  const auto file = slurp(path), copy = slurp(path + kCopy);
  if (!file || (!copy && copy.error() != ENOENT) || (copy && copy->text == file->text)) return;
  if (copy && strip_checksum(file->text) == file->text) return;  // perhaps it is damaged
  log_failure(Level::Warning, "a saved file has no copy", write_file(path + kCopy, file->text, kOursAlone));
}

void log_use_of_copy(const std::string& path) {
  log(Level::Error, "a saved file is damaged; its copy is used", {{"file", path}});
}

std::expected<void, std::string> overwrite(const std::string& path, const std::string& text) {
  const FileDescriptor fd = loop::open_regular(path, O_WRONLY | O_NOFOLLOW);
  const bool is_written = fd && loop::write_all(fd.get(), text, 0) == 0 &&
                          ftruncate(fd.get(), static_cast<off_t>(text.size())) == 0 && fsync(fd.get()) == 0;
  if (!is_written) return std::unexpected(path_error(path, errno));
  return {};
}

void remove_unwritten(const std::string& folder) {
  const auto names = names_in(folder);
  for (const std::string& name : names.value_or(std::vector<std::string>())) {
    if (name.ends_with(kBeingWritten)) unlink((folder + '/' + name).c_str());
  }
}

std::expected<void, int> for_each_name(const std::string& folder,
                                       const std::function<bool(std::string_view)>& each) {
  const std::unique_ptr<DIR, decltype([](DIR* open) { closedir(open); })> entries(opendir(folder.c_str()));
  if (!entries) return std::unexpected(errno);
  while (true) {
    errno = 0;
    const dirent* const entry = readdir(entries.get());
    if (entry == nullptr && errno != 0) return std::unexpected(errno);
    if (entry == nullptr) return {};
    const std::string_view name = entry->d_name;
    if (name != "." && name != ".." && !each(name)) return {};
  }
}

std::expected<std::vector<std::string>, std::string> names_in(const std::string& folder, std::size_t most) {
  std::vector<std::string> names;
  bool is_over = false;
  const auto read = for_each_name(folder, [&](std::string_view name) {
    is_over = names.size() == most;
    if (!is_over) names.emplace_back(name);
    return !is_over;
  });
  if (is_over) return std::unexpected(icd::sentence("holds more than ", most, " files"));
  if (!read && read.error() != ENOENT) return std::unexpected(std::system_category().message(read.error()));
  std::ranges::sort(names);
  return names;
}

std::expected<void, std::string> remove_file(const std::string& path) {
  for (const std::string& each : {path + kCopy, path}) {
    if (unlink(each.c_str()) != 0 && errno != ENOENT)
      return std::unexpected(path_error(each + ": cannot be removed", errno));
  }
  // Also for an absent file, because the sync after an earlier removal may have failed.
  if (!sync_folder(path) && errno != ENOENT) return std::unexpected(path_error(folder_of(path), errno));
  return {};
}

std::string boot() {
  const auto file = slurp("/proc/sys/kernel/random/boot_id");
  return file ? file->text.substr(0, file->text.find('\n')) : "";
}

std::string numbered_name(std::string_view prefix, std::uint64_t number, std::string_view ending) {
  std::array<char, 24> digits{};
  const int length = std::snprintf(digits.data(), digits.size(), "%08" PRIu64, number);
  return std::string(prefix).append(digits.data(), static_cast<std::size_t>(length)).append(ending);
}

std::optional<std::uint64_t> number_in_name(std::string_view name, std::string_view prefix,
                                            std::string_view ending) {
  if (!name.starts_with(prefix)) return std::nullopt;
  name.remove_prefix(prefix.size());
  if (!name.ends_with(ending)) return std::nullopt;
  name.remove_suffix(ending.size());
  return icd::number_in<std::uint64_t>(name);
}

std::expected<std::vector<std::uint64_t>, std::string> numbers_in(const std::string& folder,
                                                                  std::string_view prefix,
                                                                  std::string_view ending) {
  std::vector<std::uint64_t> numbers;
  const auto read = for_each_name(folder, [&](std::string_view name) {
    if (const auto number = number_in_name(name, prefix, ending)) numbers.push_back(*number);
    return true;
  });
  if (!read && read.error() != ENOENT) return std::unexpected(path_error(folder, read.error()));
  std::ranges::sort(numbers);
  return numbers;
}

}  // namespace adit::host
