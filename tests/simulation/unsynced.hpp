#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "simulation/random.hpp"

namespace adit::simulation {

struct Content {
  std::string bytes;       // without the hole at its end
  std::uint64_t size = 0;  // with the hole
};

/// Changes of one file that a power cut may lose.
class UnsyncedFile {
 public:
  /// `before`: the overwritten bytes; `size`: the file's size before.
  void wrote(std::uint64_t at, std::string bytes, std::string before, std::uint64_t size);
  /// Zeros were written, at or beyond the file's end.
  void wrote_zeros(std::uint64_t at, std::uint64_t length, std::uint64_t size);
  /// `cut`: the bytes beyond the new end.
  void resized(std::uint64_t from, std::uint64_t to, std::string cut);
  void synced();
  /// Changes since the last sync are never written out, although they can be read.
  void sync_failed();
  bool is_synced() const { return changes_.empty(); }
  /// The file was removed; later writes to it are lost.
  void is_gone() { gone_ = true; }
  /// The content after a power cut, if the file reads `now`.
  std::string after_power_cut(std::string now, Random& random) const;

 private:
  enum class Fate : std::uint8_t { Open, Kept, Lost };
  struct Change {
    bool resizes;
    std::uint64_t at, length, size, size_before;
    std::string bytes, before;  // bytes: empty for zeros beyond the end
    Fate fate = Fate::Open;
  };
  static void take_back(const Change& change, std::string& bytes);
  static void apply(const Change& change, std::string& bytes, Random& random);

  std::vector<Change> changes_;
  bool gone_ = false;
};

/// What a power cut may take from a directory and everything below it. Each write since a file's last sync
/// is kept, lost, or torn by sectors. Of the names that changed in a directory since its last sync, the
/// first ones are kept, as in a file system with a journal. All names are paths relative to the directory.
class Unsynced {
 public:
  using File = std::shared_ptr<UnsyncedFile>;
  File file(const std::string& name);

  void made(const std::string& name);
  /// `content`: nullopt for a directory.
  void removed(const std::string& name, std::optional<Content> content);
  /// `replaced`: the content of the file that had the name `to`.
  void renamed(const std::string& from, const std::string& to, std::optional<Content> replaced);
  void synced_folder(const std::string& name);
  /// Another directory, which is synced, has that name now.
  void replaced_folder(const std::string& name);

  /// Changes `tree`, a copy of the directory, into the state after a power cut, which is then synced.
  void cut(const std::filesystem::path& tree, Random& random);

 private:
  enum class Kind : std::uint8_t { Made, Removed, Renamed };
  struct Naming {
    Kind kind;
    std::string name, from;
    std::optional<Content> content;  // of the file that had the name before
    File file;                       // the same file's changes
  };
  /// Removes the file's name. Returns null if the file has no changes.
  File let_go(const std::string& name);
  void forget_below(const std::string& folder);
  void take_back(const Naming& naming, const std::filesystem::path& tree);

  std::map<std::string, File> files_;
  std::vector<Naming> namings_;
};

}  // namespace adit::simulation
