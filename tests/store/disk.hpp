#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "simulation/random.hpp"
#include "simulation/unsynced.hpp"

namespace adit::store {

using simulation::Random;

/// A directory of real files with simulated faults: calls of libc that change files (disk.cpp) end in a
/// kill, fail, or are lost in a power cut. Only one at a time.
class Disk {
 public:
  /// Thrown by a call of libc in which the process is killed.
  struct Killed {};

  /// `directory`: of the log, below the test's own directory.
  explicit Disk(Random random, std::string directory = "log");
  ~Disk();
  Disk(const Disk&) = delete;
  Disk& operator=(const Disk&) = delete;

  const std::string& path() const { return path_; }
  std::string log() const { return path_ + '/' + directory_; }
  /// Starts the next process.
  void start();
  /// Unsynced changes may be lost.
  void cut_power();
  /// Flips one bit of the non-zero bytes on the disk.
  void flip_bit();
  /// Makes a file 1 TB long. The disk can lose no more power then.
  void lengthen();
  std::map<std::string, std::string> files() const;
  /// Puts these files in place of all others.
  void replace(const std::map<std::string, std::string>& files) const;

  // Probabilities per call.
  double kills = 0, failing_syncs = 0, failing_writes = 0, full = 0, failing_opens = 0;
  bool is_read_only = false;
  std::optional<std::size_t> room;  // bytes that files may grow by
  std::string failing_file = "";    // files with this prefix cannot be opened
  std::size_t kill_at = 0;          // calls until the kill; 0: never

  // For disk.cpp only.
  static Disk* of(int fd, const char* name);
  int open(int folder, const char* name, int flags, mode_t mode);
  ssize_t write(int fd, const char* bytes, std::size_t size, off_t at);
  int sync(int fd);
  int rename(const char* from, const char* to);
  int remove(const char* name);

 private:
  void may_be_killed();
  bool fails(double chance, int error);
  std::optional<simulation::Content> content(const std::string& name) const;
  std::string name_of(int fd) const;

  Random random_;
  std::string path_;
  const std::string directory_;
  std::unique_ptr<simulation::Unsynced> unsynced_;
  bool is_dead_ = false;
};

}  // namespace adit::store
