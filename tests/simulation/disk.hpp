#pragma once

#include <sys/types.h>

#include <filesystem>
#include <functional>
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

/// The box's directory: `runtime` is in memory, all else on the disk. The files are real. This class stands
/// between them and the running process: its calls may be the process's last, meet the disk's faults, and
/// record what a power cut may lose. posix.cpp passes it the calls of libc that read or change files.
class Disk {
 public:
  static constexpr const char* kRuntime = "runtime";
  static constexpr const char* kSettings = "state/settings.json";
  static constexpr const char* kLedger = "state/ledger";
  static constexpr std::uint64_t kRoom = 256 << 20;  // bytes of each file system

  explicit Disk(World& world);
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  /// The disk of this path, or of this open file; null if it is not in the box's directory, or if no
  /// process runs.
  static Disk* of(int folder, const char* path);
  static Disk* of(int fd);
  /// Call after the descriptor was closed.
  static void forget(int fd);

  /// Sets the box's directory.
  void mount(const std::filesystem::path& folder);
  /// A digest of the saved settings; "" if there are none.
  std::string settings() const;
  /// Call when no process has a file open any more.
  void let_go() { open_.clear(); }
  /// Changes `tree`, a copy of the directory, into the files after a power cut.
  void cut_power(const std::filesystem::path& tree);
  /// Call after a person has replaced the ledger's directory while no process runs.
  void ledger_replaced() { unsynced_.replaced_folder(kLedger); }
  /// Calls `look`, whose calls are not the box's: no fault hits them.
  void look_on(const std::function<void()>& look);
  DiskFaults& faults() { return faults_; }
  CallFaults& calls() { return calls_; }

  // As in libc: -1 and errno on failure.
  int open(int folder, const char* path, int flags, mode_t mode);
  /// `at`: the offset; nullopt: the file's own position.
  ssize_t write(int fd, std::span<const char> bytes, std::optional<off_t> at);
  ssize_t read(int fd, void* to, std::size_t size, std::optional<off_t> at);
  /// Returns -1 and sets errno if a fault makes this call fail, otherwise 0.
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
  /// Six letters for a temporary name.
  std::string unique();
  /// Fills `bytes` from the run's seed. Returns false if no run is on.
  static bool fill_random(void* bytes, std::size_t size);
  /// Total size of the files whose names below the directory begin with `beginning`.
  std::uint64_t stored(const std::string& beginning);
  /// Free bytes in the file system of that path.
  std::uint64_t room(int folder, const char* path);
  std::uint64_t room(int fd);

 private:
  struct Open {
    std::string name;  // relative to the box's directory
    Unsynced::File file;
    bool appends, is_folder;
    std::uint64_t device, number;  // to detect that libc itself closed it
    bool is_broken = false;        // the next read or write fails
  };
  static bool is_on();
  std::string name_of(int folder, const char* path) const;
  static bool is_in_memory(const std::string& name);
  bool is_read_only(const std::string& name) const;
  bool is_full(const std::string& name) const;
  /// Reserves room for `bytes` new bytes and returns how many were available.
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
  std::string folder_;  // ends with a slash
  std::map<int, Open> open_;
  bool looks_on_ = false;  // a check reads the files, without faults
};

}  // namespace adit::simulation
