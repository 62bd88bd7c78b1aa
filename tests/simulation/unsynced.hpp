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

/// What is in a file.
struct Content {
  std::string bytes;       // but for the hole at its end
  std::uint64_t size = 0;  // with it
};

/// What was done to one file and may be gone after a power cut.
class UnsyncedFile {
 public:
  /// `before`: what it had there; `size`: its size until then.
  void wrote(std::uint64_t at, std::string bytes, std::string before, std::uint64_t size);
  /// So many zeros, from its end or farther on.
  void wrote_zeros(std::uint64_t at, std::uint64_t length, std::uint64_t size);
  /// `cut`: what was behind the new end.
  void resized(std::uint64_t from, std::uint64_t to, std::string cut);
  void synced();
  /// What was not synced until then never will be, though it reads well.
  void sync_failed();
  bool is_synced() const { return changes_.empty(); }
  /// It has no name any more: what is still written to it reaches nobody.
  void is_gone() { gone_ = true; }
  /// What is left of a file that reads `now`.
  std::string after_power_cut(std::string now, Random& random) const;

 private:
  enum class Fate : std::uint8_t { Open, Kept, Lost };
  struct Change {
    bool resizes;
    std::uint64_t at, length, size, size_before;
    std::string bytes, before;  // bytes: none where they are zeros behind the end
    Fate fate = Fate::Open;
  };
  static void take_back(const Change& change, std::string& bytes);
  static void apply(const Change& change, std::string& bytes, Random& random);

  std::vector<Change> changes_;
  bool gone_ = false;
};

/// What a power cut may take from a folder and all below it: each write since its file's last sync is kept,
/// lost, or torn by sectors, and of the names that changed in a folder since that was synced, as many as are
/// kept are the first ones, as in a file system with a journal. All names are paths below the folder.
class Unsynced {
 public:
  using File = std::shared_ptr<UnsyncedFile>;
  File file(const std::string& name);

  void made(const std::string& name);
  /// `content`: what was in it, where it was a file.
  void removed(const std::string& name, std::optional<Content> content);
  /// `replaced`: what was in the file that had the name until then.
  void renamed(const std::string& from, const std::string& to, std::optional<Content> replaced);
  void synced_folder(const std::string& name);

  /// Changes `tree`, a copy of the folder, into what is left of it, which is on the disk for good.
  void cut(const std::filesystem::path& tree, Random& random);

 private:
  enum class Kind : std::uint8_t { Made, Removed, Renamed };
  struct Naming {
    Kind kind;
    std::string name, from;
    std::optional<Content> content;  // of what had the name before
    File file;                       // so, too
  };
  /// Of the file that loses this name; null: none is known.
  File let_go(const std::string& name);
  void forget_below(const std::string& folder);
  void take_back(const Naming& naming, const std::filesystem::path& tree);

  std::map<std::string, File> files_;
  std::vector<Naming> namings_;
};

}  // namespace adit::simulation
