#pragma once

#include <sys/types.h>

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

#include "simulation/call_faults.hpp"
#include "simulation/disk_faults.hpp"
#include "simulation/random.hpp"
#include "simulation/unsynced.hpp"

namespace adit::simulation {

class World;

/// The box's folder, of which all but `runtime` is on the disk, and that in memory. The files are real; this
/// stands between them and the process that lives: its calls take part in deaths, meet the disk's faults, and
/// leave behind what a power cut may take. posix.cpp hands it the calls of libc that change files.
class Disk {
 public:
  static constexpr const char* kRuntime = "runtime";
  static constexpr const char* kSettings = "state/settings.json";
  static constexpr std::uint64_t kRoom = 256 << 20;  // bytes, of each file system

  explicit Disk(World& world);
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// The one that this path belongs to, or this open file: null where it is no business of the box's, or no
  /// process lives.
  static Disk* of(int folder, const char* path);
  static Disk* of(int fd);
  /// Is closed.
  static void forget(int fd);

  /// The folder that is the box's from now on.
  void mount(const std::filesystem::path& folder);
  /// No process has anything open any more.
  /// Stands for what the saved settings say; "": there are none.
  std::string settings() const;
  void let_go() { open_.clear(); }
  /// Changes `tree`, a copy of the folder, into what a power cut leaves of it.
  void cut_power(const std::filesystem::path& tree);
  DiskFaults& faults() { return faults_; }
  CallFaults& calls() { return calls_; }

  // As in libc, each; -1 and errno where it fails.
  int open(int folder, const char* path, int flags, mode_t mode);
  /// `at`: where it does not go on at the file's own place.
  ssize_t write(int fd, std::span<const char> bytes, std::optional<off_t> at);
  ssize_t read(int fd, void* to, std::size_t size, std::optional<off_t> at);
  /// -1 and errno if a fault makes this call fail; else 0.
  int fails(CallFaults::Call call, int fd);
  int fails(CallFaults::Call call, int folder, const char* path);
  int truncate(int fd, off_t size);
  int allocate(int fd, int mode, off_t at, off_t size);
  int sync(int fd);
  int rename(int from_folder, const char* from, int to_folder, const char* to);
  int unlink(int folder, const char* path, int flags);
  int make_folder(int folder, const char* path, mode_t mode);
  int link(int from_folder, const char* from, int to_folder, const char* to);
  int may_change(int folder, const char* path);
  /// Six letters for a new name.
  std::string unique();
  /// Bytes that come from the run's seed. False: no run is on.
  static bool fill_random(void* bytes, std::size_t size);
  /// The bytes of all files whose names below the folder begin so.
  std::uint64_t stored(const std::string& beginning);
  /// Bytes that are left in the file system of that path.
  std::uint64_t room(int folder, const char* path);
  std::uint64_t room(int fd);

 private:
  struct Open {
    std::string name;  // below the folder
    Unsynced::File file;
    bool appends, is_folder;
    std::uint64_t device, number;  // what it was: libc itself may have closed it
    bool is_broken = false;        // the next read or write fails
  };
  static bool is_on();
  std::string name_of(int folder, const char* path) const;
  static bool is_in_memory(const std::string& name);
  bool is_read_only(const std::string& name) const;
  bool is_full(const std::string& name) const;
  /// How many of so many new bytes there is room for.
  std::uint64_t take_room(const std::string& name, std::uint64_t bytes);
  std::optional<std::size_t> cut(CallFaults::Call call, int fd, std::size_t size);
  std::uint64_t cut(const Open& open, std::uint64_t size, off_t at);
  ssize_t put(int fd, const Open& open, std::span<const char> bytes, off_t at);
  std::optional<Content> content_of(const std::string& name) const;
  void note_settings(const std::string& mark);

  World& world_;
  Random random_, unique_;
  DiskFaults faults_;
  CallFaults calls_;
  Unsynced unsynced_;
  std::string folder_;  // with a slash at its end
  std::map<int, Open> open_;
  bool looks_on_ = false;  // a check reads the files, and no fault is in its way
};

}  // namespace adit::simulation
