#include "simulation/unsynced.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <utility>

namespace adit::simulation {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kSector = 512;

std::string folder_of(const std::string& name) {
  const auto slash = name.rfind('/');
  return slash == std::string::npos ? "" : name.substr(0, slash);
}

std::string read_file(const fs::path& path) {
  std::string bytes(fs::file_size(path), '\0');
  std::ifstream(path, std::ios::binary).read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return bytes;
}

/// Recreates a file with the mode of all files of the box. Recreates its directory, because the removal of
/// a directory is synced no earlier than the removal of its last file.
void write_file(const fs::path& path, const std::string& bytes) {
  const bool is_new = !fs::exists(path);
  if (fs::create_directory(path.parent_path())) fs::permissions(path.parent_path(), fs::perms::owner_all);
  std::ofstream(path, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (is_new) fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
}

}  // namespace

void UnsyncedFile::wrote(std::uint64_t at, std::string bytes, std::string before, std::uint64_t size) {
  if (gone_) return;
  const std::uint64_t length = bytes.size(), end = std::max(size, at + length);
  changes_.push_back({false, at, length, end, size, std::move(bytes), std::move(before)});
}

void UnsyncedFile::wrote_zeros(std::uint64_t at, std::uint64_t length, std::uint64_t size) {
  if (gone_) return;
  changes_.push_back({false, at, length, at + length, size, "", ""});
}

void UnsyncedFile::resized(std::uint64_t from, std::uint64_t to, std::string cut) {
  if (gone_) return;
  changes_.push_back({true, std::min(from, to), 0, to, from, "", std::move(cut)});
}

void UnsyncedFile::synced() {
  if (std::ranges::none_of(changes_, [](const Change& change) { return change.fate == Fate::Lost; }))
    return changes_.clear();
  for (Change& change : changes_) {
    if (change.fate == Fate::Open) change.fate = Fate::Kept;
  }
}

void UnsyncedFile::sync_failed() {
  for (Change& change : changes_) {
    if (change.fate == Fate::Open) change.fate = Fate::Lost;
  }
}

void UnsyncedFile::take_back(const Change& change, std::string& bytes) {
  bytes.resize(std::max<std::uint64_t>(bytes.size(), change.at + change.before.size()));
  bytes.replace(change.at, change.before.size(), change.before);
  bytes.resize(change.size_before);
}

/// Applies all sectors of the change, or each with probability 1/2. The size is then that of the written
/// sectors or the final one.
void UnsyncedFile::apply(const Change& change, std::string& bytes, Random& random) {
  if (change.resizes) return bytes.resize(change.size);
  const bool whole = change.fate == Fate::Kept || random.chance(0.6);
  for (std::uint64_t done = 0; done < change.length;) {
    const std::uint64_t at = change.at + done;
    const std::uint64_t size = std::min(kSector - at % kSector, change.length - done);
    if (whole || random.chance(0.5)) {
      bytes.resize(std::max<std::uint64_t>(bytes.size(), at + size));
      change.bytes.empty() ? bytes.replace(at, size, size, '\0')
                           : bytes.replace(at, size, change.bytes, done, size);
    }
    done += size;
  }
  if (!whole && random.chance(0.5)) bytes.resize(std::max<std::uint64_t>(bytes.size(), change.size));
}

/// In a third of the cuts no change was written out, in a third all changes up to one, in a third any of
/// them.
std::string UnsyncedFile::after_power_cut(std::string now, Random& random) const {
  for (auto change = changes_.rbegin(); change != changes_.rend(); ++change) take_back(*change, now);
  const std::uint64_t how = random.uniform_index(3), first = random.uniform_index(changes_.size() + 1);
  for (std::size_t i = 0; i < changes_.size(); ++i) {
    const Change& change = changes_[i];
    const bool is_out = how == 1 ? i < first : how == 2 && random.chance(0.5);
    if (change.fate == Fate::Kept || (change.fate == Fate::Open && is_out)) {
      apply(change, now, random);
    } else if (change.fate == Fate::Open && how == 2 && random.chance(0.3)) {
      now.resize(std::max<std::uint64_t>(now.size(), change.size));  // only its size
    }
  }
  return now;
}

Unsynced::File Unsynced::file(const std::string& name) {
  File& file = files_[name];
  if (!file) file = std::make_shared<UnsyncedFile>();
  return file;
}

Unsynced::File Unsynced::let_go(const std::string& name) {
  const auto found = files_.extract(name);
  if (!found) return nullptr;
  found.mapped()->is_gone();
  return found.mapped();
}

void Unsynced::made(const std::string& name) {
  let_go(name);
  namings_.push_back({Kind::Made, name, "", std::nullopt, nullptr});
}

void Unsynced::removed(const std::string& name, std::optional<Content> content) {
  namings_.push_back({Kind::Removed, name, "", std::move(content), let_go(name)});
}

/// Simplification: changes of names count as synced if their directory is renamed, or if a name leaves the
/// directory.
void Unsynced::renamed(const std::string& from, const std::string& to, std::optional<Content> replaced) {
  namings_.push_back({Kind::Renamed, to, from, std::move(replaced), let_go(to)});
  if (auto file = files_.extract(from)) {
    file.key() = to;
    files_.insert(std::move(file));
  }
  forget_below(from);
  if (folder_of(from) != folder_of(to)) synced_folder(folder_of(from));
}

void Unsynced::forget_below(const std::string& folder) {
  const std::string begins = folder + '/';
  std::erase_if(files_, [&](const auto& each) { return each.first.starts_with(begins); });
  std::erase_if(namings_, [&](const Naming& each) { return each.name.starts_with(begins); });
}

void Unsynced::replaced_folder(const std::string& name) {
  forget_below(name);
  std::erase_if(namings_, [&](const Naming& each) { return each.name == name; });
}

void Unsynced::synced_folder(const std::string& name) {
  std::erase_if(namings_, [&](const Naming& each) { return folder_of(each.name) == name; });
}

void Unsynced::take_back(const Naming& naming, const fs::path& tree) {
  const fs::path path = tree / naming.name;
  if (naming.kind == Kind::Made) {
    fs::remove_all(path);
    files_.erase(naming.name);
    return;
  }
  if (naming.kind == Kind::Renamed) {
    fs::rename(path, tree / naming.from);
    if (auto file = files_.extract(naming.name)) {
      file.key() = naming.from;
      files_.insert(std::move(file));
    }
  }
  if (naming.content) {
    write_file(path, naming.content->bytes);
    fs::resize_file(path, naming.content->size);
    if (naming.file) files_[naming.name] = naming.file;
  } else if (naming.kind == Kind::Removed) {
    fs::create_directory(path);
  }
}

void Unsynced::cut(const fs::path& tree, Random& random) {
  std::map<std::string, std::uint64_t> changed, kept;
  for (const Naming& each : namings_) ++changed[folder_of(each.name)];
  for (const auto& [folder, count] : changed) {
    const double how = random.unit();
    kept[folder] = how < 0.4 ? 0 : how < 0.6 ? count : random.uniform_index(count + 1);
  }
  while (!namings_.empty()) {
    const Naming last = std::move(namings_.back());
    namings_.pop_back();
    const std::string folder = folder_of(last.name);
    if (changed[folder]-- > kept[folder]) take_back(last, tree);
  }
  for (const auto& [name, file] : std::exchange(files_, {})) {
    const fs::path path = tree / name;
    if (file->is_synced() || !fs::is_regular_file(path)) continue;
    write_file(path, file->after_power_cut(read_file(path), random));
  }
}

}  // namespace adit::simulation
