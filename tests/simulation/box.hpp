#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "simulation/random.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {

/// The box: its folders, and the lives of aditd, one after the other.
class Box {
 public:
  /// The interface to the Command Post, and in half of the runs the team's: one that every machine has.
  static constexpr const char* kInterface = "lo";

  /// Makes a folder in memory, which goes with this. `world` outlives it.
  explicit Box(World& world);
  ~Box();
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  /// Lives until finish() was called and the process has ended.
  void live();
  /// SIGTERM, for good.
  void finish();
  void terminate();
  /// At a drawn call of the seam from now on, or from the next start on.
  void die(World::How how);

  std::string state() const { return (folder_ / "state").string(); }
  std::string runtime() const { return (folder_ / "runtime").string(); }
  std::string secrets() const { return (folder_ / "secrets").string(); }
  /// Of maps that may wait by the first settings, one that comes back with them.
  std::size_t most_map_bytes() const { return most_map_bytes_; }
  std::string settings() const { return (folder_ / "settings.json").string(); }

 private:
  void one_life();
  void die_soon(World::How how);
  void died();
  void lost_power();

  World& world_;
  Random random_;
  std::filesystem::path top_, folder_, next_;
  std::size_t most_map_bytes_ = 0;
  int folders_ = 0;
  bool finished_ = false, boots_ = false, starts_again_ = false;
  std::optional<World::How> dies_at_start_;
};

}  // namespace adit::simulation
