#pragma once

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "icd/grid_bounds.hpp"
#include "icd/mapping.hpp"
#include "spool/kept_message.hpp"

namespace adit::spool {

/// Stores queued maps so that they survive a crash of the service, not of the machine, because the directory
/// is in memory. A stored map is complete or absent.
class Spool {
 public:
  /// How processes ended while they packed a map, since it was last packed.
  struct EndCounts {
    /// So many faults are the map's own, and so many other ends may be.
    static constexpr int kMost = 3;
    int faults = 0;  // in the thread that packed it, or that took longer than the watchdog allows
    int others = 0;  // SIGKILL, for example
    friend bool operator==(const EndCounts&, const EndCounts&) = default;
  };
  struct KeptMap {
    std::uint64_t number = 0;
    icd::MapUpdate map;
    std::optional<icd::GridBounds> bounds{};  // keep_bounds()
    EndCounts ends{};
  };
  using KeptMaps = std::vector<KeptMap>;  // by number

  /// Creates the directory for this user alone. `left_to_others`: bytes of its file system that maps must
  /// leave free, at most a quarter of it, because other files there must not fail for want of room.
  explicit Spool(std::string folder, std::uint64_t left_to_others = 0);
  ~Spool();
  Spool(const Spool&) = delete;
  Spool& operator=(const Spool&) = delete;

  /// Changes `left_to_others`. Any thread.
  void set_reserved(std::uint64_t bytes) { left_to_others_ = bytes; }

  /// A file for a map's data as it arrives. Release the last reference in the writer thread.
  std::shared_ptr<MapFile> begin() { return std::make_shared<MapFile>(folder_ + "/arriving"); }
  /// Whether `bytes` more fit.
  bool has_room(std::uint64_t bytes) const;
  /// Stores a map until forget() and returns it with its data mapped from the file. Each chunk is freed once
  /// it is written. `begun` is used if the map's data begins with its stored data. Error 503, without a file:
  /// no room for the map and `spare` bytes more, the directory cannot be written, or read() failed. After a
  /// failed read(), the number may belong to an unread map. Writer thread.
  icd::Checked<icd::MapUpdate> keep(std::uint64_t number, icd::MapUpdate map, std::uint64_t spare,
                                    std::shared_ptr<MapFile> begun = nullptr);
  /// Stores the bounds of a grid and of all that it replaced beside the map, until forget(). False: they
  /// cannot be written. Writer thread.
  bool keep_bounds(std::uint64_t number, const icd::GridBounds& bounds) const;
  /// Removes the files. Mapped data stays valid for its owners. Writer thread.
  void forget(std::uint64_t number);
  /// Why maps cannot be stored, or "".
  std::string trouble() const;

  /// Record which maps are being packed, so that the next read() counts it if the process ends meanwhile.
  /// `are_packed`: forgets their earlier ends. On the loop, as read().
  void begin_work(std::vector<std::uint64_t> numbers);
  void end_work(bool are_packed);
  /// The work takes longer than the watchdog allows: if the process ends now, it is a fault.
  void record_overrun() const;
  /// A file for loop::FaultCounter, during the work.
  std::string work_file() const { return folder_ + "/at-work"; }
  /// Begins with earlier ends of a map that keep() has stored under another number.
  void remember(std::uint64_t number, const EndCounts& ends);
  /// The maps are not queued any more.
  void forget_ends(std::span<const std::uint64_t> numbers);
  /// A sentence that names maps that read() set aside, and why; or "".
  const std::string& put_aside() const { return put_aside_; }

  /// Reads all stored maps. A damaged file is logged and set aside; so is one that can never be read (wrong
  /// owner, no regular file) if others can. If a file cannot be read now, all files stay, the result is
  /// empty, and keep() rejects every map until the next start, because none may precede an older one.
  KeptMaps read();
  /// Why read() could not read a file, or "".
  const std::string& unread() const { return unread_; }
  /// Renames a damaged file so that the spool ignores it and a person can examine it. Writer thread.
  void set_aside(std::uint64_t number, const std::string& why);

 private:
  std::string file_of(std::uint64_t number) const;
  std::string bounds_file_of(std::uint64_t number) const;
  icd::Checked<KeptMap> read(std::uint64_t number) const;
  void count_ends();
  void write_work();
  void put_aside(std::uint64_t number, const std::string& why);

  std::string folder_, unread_;  // unread_: why read() failed
  std::map<std::uint64_t, EndCounts> ends_;
  std::vector<std::uint64_t> at_work_;
  std::string put_aside_;
  std::atomic<std::uint64_t> left_to_others_;  // also read by the writer thread
};

}  // namespace adit::spool
