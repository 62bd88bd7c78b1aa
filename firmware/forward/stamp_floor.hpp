#pragma once

#include <expected>
#include <memory>
#include <optional>
#include <string>

#include "lanes/stamps.hpp"
#include "ledger/ledger.hpp"

namespace adit::forward {

/// Keeps stamps from going back when the machine restarts (promise 5): a box without a battery-backed clock
/// has about the same time at each start. A file in the state folder holds a bound that no stamp has passed.
/// It is ahead of the stamps, so that it need be written only now and then, and nobody waits for it. Beside
/// it is the time of day as it was then.
class StampFloor {
 public:
  struct Kept {
    double floor = 0, wall = 0;  // seconds since 1970; 0: nothing is known
    double least = 0;  // no stamp may be earlier, even where the machine did not restart: another box's were
    ledger::Known ledger = {};  // if the ledger has less, it is damaged
  };
  static constexpr const char* kFile = "stamps";
  static constexpr double kEvery = 10;  // seconds
  /// Stamps are up to kJump ahead of now, and a disk may be slow.
  static constexpr double kAhead = lanes::StampShift::kJump + kEvery + 15;

  explicit StampFloor(const std::string& state_folder) : file_(state_folder + '/' + kFile) {}

  /// A damaged file is logged and counts as none. An error: the file cannot be read, and must not be written.
  std::expected<Kept, std::string> read() const;

  /// What is to be written by now, if anything. `now`: by the clock for stamps; `wall`: the time of day.
  std::optional<Kept> due(double now, double wall, const ledger::Known& ledger);
  /// By the next time that this is asked.
  void is_due() { next_ = 0; }
  /// May be called on a worker, one call after the other, and on copies. A failure to write is logged once,
  /// until a write succeeds or fails in another way.
  void write(const Kept& kept);

 private:
  std::string file_;
  std::shared_ptr<std::string> trouble_ = std::make_shared<std::string>();  // the writer's
  double next_ = 0;
};

}  // namespace adit::forward
