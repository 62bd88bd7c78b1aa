#pragma once

#include <cstdint>
#include <string>

#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// Faults of the box's disk, in two of five runs, of one kind or two. Each lasts up to 15 s, from the start
/// or later.
class DiskFaults {
 public:
  enum class Kind : std::uint8_t {
    Full,       // writes that make a file longer fail; some bytes are left
    SyncFails,  // once, or for the whole time
    ReadOnly,
    Slow,         // some syncs take up to 5 s
    RuntimeFull,  // the directory in memory
    Unreadable,   // opening a file for reading fails
    End
  };

  explicit DiskFaults(World& world);
  /// Draws the times of the faults. Each may be left out by its name.
  void plan(double trouble_for);
  bool is(Kind kind) const { return is_[static_cast<int>(kind)]; }
  /// Bytes that are left while the disk is full.
  std::uint64_t& room(bool in_memory) { return room_[in_memory ? 1 : 0]; }
  bool sync_fails();
  /// Seconds that a sync takes now.
  double sync_takes();
  /// The kinds in this run, "; disk: Full Slow", or "".
  const std::string& names() const { return names_; }

 private:
  /// The details of one fault, drawn when it was planned.
  struct Drawn {
    bool fails_once = false;
    std::uint64_t room = 0;
    Random delays;  // while it is slow
  };
  void plan(Kind kind, double trouble_for);
  void begin(Kind kind, const Drawn& drawn);
  void end(Kind kind);

  World& world_;
  Random random_, delays_;
  bool is_[static_cast<int>(Kind::End)] = {};
  bool fails_once_ = false;
  std::uint64_t planned_ = 0;
  std::uint64_t room_[2] = {};
  std::string names_;
};

}  // namespace adit::simulation
