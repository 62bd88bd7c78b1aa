#pragma once

#include <cstdint>
#include <string>

#include "simulation/random.hpp"

namespace adit::simulation {

class World;

/// What may be wrong with the box's disk for a time. Most runs have none of it, the others one kind or two.
class DiskFaults {
 public:
  enum class Kind : std::uint8_t {
    Full,       // for what makes a file longer: some bytes are left
    SyncFails,  // once, or all of them
    ReadOnly,
    Slow,         // some syncs take up to 5 s
    RuntimeFull,  // the folder in memory
    Unreadable,   // a file that is opened to be read
    End
  };

  explicit DiskFaults(World& world);
  /// Draws when they come. Each may be left out, by its name.
  void plan(double trouble_for);
  bool is(Kind kind) const { return is_[static_cast<int>(kind)]; }
  /// Bytes that are left while it is full.
  std::uint64_t& room(bool in_memory) { return room_[in_memory ? 1 : 0]; }
  bool sync_fails();
  /// Seconds that a sync takes.
  double sync_takes();
  /// "; disk: Full Slow", or "".
  const std::string& names() const { return names_; }

 private:
  /// What one that begins is like, drawn before.
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
