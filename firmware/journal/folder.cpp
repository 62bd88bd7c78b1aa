#include "journal/folder.hpp"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string_view>
#include <system_error>

#include "host/files.hpp"
#include "host/log.hpp"
#include "host/numbered_name.hpp"
#include "host/service.hpp"

namespace adit::journal {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kJournal = "journal-", kSnapshot = "snapshot-", kPart = ".part";

/// Whether the records end as those of a whole snapshot do; an error if the file cannot be read.
std::expected<bool, std::string> replay(const std::string& path, Carried& carried,
                                        const std::atomic<bool>& enough) {
  const auto file = host::slurp(path, std::numeric_limits<std::size_t>::max());
  if (!file) return std::unexpected(host::trouble(path, file.error()));
  bool whole = false;
  std::size_t unknown = 0;
  for_each_record(file->text, [&](Kind kind, std::string_view said) {
    whole = kind == Kind::End;
    if (!carried.apply(kind, said)) ++unknown;
    return !enough;
  });
  if (unknown > 0) {
    host::log(host::Level::Error, "unknown journal records skipped",
              {{"file", path}, {"records", std::to_string(unknown)}});
  }
  return whole;
}

}  // namespace

Folder::Folder(std::string path) : path_(std::move(path)) {
  std::error_code error;
  fs::create_directories(path_, error);
  fs::permissions(path_, fs::perms::owner_all, error);
}

std::string Folder::file(const char* kind, std::uint64_t number) const {
  return path_ + '/' + host::numbered_name(kind, number);
}

std::expected<Folder::Files, std::string> Folder::files() const {
  Files files;
  const auto read = host::for_each_name(path_, [&](std::string_view name) {
    if (const auto number = host::number_in_name(name, kJournal)) files.journals.push_back(*number);
    if (const auto number = host::number_in_name(name, kSnapshot)) files.snapshots.push_back(*number);
    if (name.ends_with(kPart)) files.parts.push_back(path_ + '/' + std::string(name));
    return true;
  });
  const bool is_absent = !read && (read.error() == ENOENT || read.error() == ENOTDIR);
  if (!read && !is_absent) return std::unexpected(host::trouble(path_, read.error()));
  std::ranges::sort(files.journals);
  std::ranges::sort(files.snapshots);
  return files;
}

std::expected<std::uint64_t, std::string> Folder::last() const {
  const auto all = files();
  if (!all) return std::unexpected(all.error());
  return std::max(all->journals.empty() ? 0 : all->journals.back(),
                  all->snapshots.empty() ? 0 : all->snapshots.back());
}

std::expected<Carried, std::string> Folder::read() const {
  return read(std::numeric_limits<std::uint64_t>::max(), false);
}

std::expected<Carried, std::string> Folder::read(std::uint64_t last, const std::atomic<bool>& enough) const {
  const auto all = files();
  if (!all) return std::unexpected(all.error());
  Carried carried;
  std::uint64_t first = 0;
  for (auto number = all->snapshots.rbegin(); number != all->snapshots.rend() && first == 0; ++number) {
    Carried kept;
    const auto whole = replay(snapshot(*number), kept, enough);
    if (!whole) return std::unexpected(whole.error());
    if (!*whole) continue;
    carried = std::move(kept);
    first = *number;
  }
  for (const std::uint64_t number : all->journals) {
    if (number < first || number > last || enough) continue;
    if (const auto read = replay(journal(number), carried, enough); !read)
      return std::unexpected(read.error());
  }
  return carried;
}

std::expected<std::size_t, std::string> Folder::compact(std::uint64_t last, const std::atomic<bool>& enough) {
  const auto carried = read(last, enough);
  if (!carried) return std::unexpected(carried.error());
  const std::string path = snapshot(last + 1), part = path + std::string(kPart);
  std::ofstream file(part, std::ios::binary | std::ios::trunc);
  std::size_t size = 0;
  const auto write = [&](Kind kind, std::string_view said) {
    const std::string record = framed(kind, said);
    file.write(record.data(), static_cast<std::streamsize>(record.size()));
    size += record.size();
  };
  if (!enough) carried->write(write);
  write(Kind::End, {});
  file.close();
  std::error_code error;
  if (file && !enough) fs::rename(part, path, error);
  if (file && !enough && !error) {
    remove_before(last + 1);
    return size;
  }
  fs::remove(part, error);
  return std::unexpected(enough ? "aditd is stopping" : path + ": cannot be written");
}

void Folder::remove_before(std::uint64_t number) {
  const Files all = files().value_or(Files{});  // unread: the next snapshot removes these files
  std::error_code error;
  for (const std::string& part : all.parts) fs::remove(part, error);  // death came while it was written
  for (const std::uint64_t each : all.journals) {
    if (each < number) fs::remove(journal(each), error);
  }
  for (const std::uint64_t each : all.snapshots) {
    if (each < number) fs::remove(snapshot(each), error);
  }
}

}  // namespace adit::journal
