#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "simulation/random.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {

/// The box: its directories, and the processes of aditd, one after the other.
class Box {
 public:
  /// The interface to the Command Post, and in half of the runs the interface to the team. Every machine
  /// has it.
  static constexpr const char* kInterface = "lo";

  /// Makes a directory in memory and removes it on destruction. `world` must outlive the box.
  explicit Box(World& world);
  ~Box();
  Box(const Box&) = delete;
  Box& operator=(const Box&) = delete;

  /// Runs aditd again and again until finish() was called and the process has ended.
  void live();
  /// Sends SIGTERM; aditd is not started again.
  void finish();
  void terminate();
  /// The process dies at a drawn call of the seam, counted from now or from the next start.
  void die(World::How how);
  /// Copies the ledger's directory as it reads now. The copy replaces the one before. In one of five runs a
  /// person does so once or twice, and up to a minute later ends the process and puts the copy back. The rest
  /// of the state directory and the runtime directory stay.
  void copy_ledger();
  /// The next process after this one starts with the copy in place of the ledger. No effect without a copy.
  void put_ledger_back();

  std::string state() const { return (folder_ / "state").string(); }
  std::string runtime() const { return (folder_ / "runtime").string(); }
  std::string secrets() const { return (folder_ / "secrets").string(); }
  /// Limit of queued maps in the first settings, plus one map that is queued again.
  std::size_t most_map_bytes() const { return most_map_bytes_; }
  std::string settings() const { return (folder_ / "settings.json").string(); }

 private:
  void run_process();
  void die_soon(World::How how);
  void died();
  void lost_power();
  void replace_ledger();

  World& world_;
  Random random_;
  std::filesystem::path top_, folder_, next_;
  std::size_t most_map_bytes_ = 0;
  int folders_ = 0;
  bool finished_ = false, boots_ = false, starts_again_ = false;
  bool has_copy_ = false, is_copy_due_ = false;
  std::optional<World::How> dies_at_start_;
};

}  // namespace adit::simulation
