#pragma once

#include <atomic>
#include <expected>
#include <memory>
#include <optional>
#include <string>
#include <tuple>

#include "ledger/ledger.hpp"
#include "queues/stamps.hpp"
#include "store/frame.hpp"

namespace adit::forward {

/// Prevents stamps from running back after a boot (promise 5). A box without a battery-backed clock has about
/// the same time at each boot. A file in the state directory holds a bound above all stamps, ahead of them,
/// so that it is written seldom and without a wait. The file also has the time of day. It is one frame of a
/// log (store/README.md) in two copies, with salt 0.
class StampFloor {
 public:
  struct Kept {
    double floor = 0, wall = 0;  // seconds since 1970; 0: unknown
    double least = 0;            // lowest allowed stamp, for stamps of another box
    ledger::Known ledger = {};   // a ledger with less is damaged
    /// Seconds by which stamps were ahead of the time of day, by the last source that told it.
    std::optional<double> lead = {};
    double overruled = 0;     // times in the ledger up to it are no stamps, after forget()
    bool is_damaged = false;  // no copy is good; not in the file

    friend bool operator==(const Kept&, const Kept&) = default;
  };
  static constexpr const char* kFile = "stamps";
  static constexpr double kEvery = 150;  // seconds
  static constexpr double kSoon = 10;    // seconds, if the ledger has grown or the last write failed
  /// Stamps may be kJump ahead of now, and a disk may be slow.
  static constexpr double kAhead = queues::StampShift::kJump + kEvery + 15;
  static constexpr double kMostAhead = 86400;  // seconds beyond the time of day; more needs an operator

  explicit StampFloor(const std::string& state_folder) : file_(state_folder + '/' + kFile) {}

  /// Logs a damaged copy and uses the other one. All values are 0 without a good copy. An error: the
  /// file is unreadable, and must not be written.
  std::expected<Kept, std::string> read() const;

  /// The values to write now, if due. `now`: stamp clock; `wall`: time of day.
  std::optional<Kept> due(double now, double wall, const ledger::Known& ledger);
  /// The next due() returns values.
  void is_due() { last_ = 0; }
  /// May run on a worker, one call at a time, on copies. Logs a failure when its text changes.
  void write(const Kept& kept);
  /// Removes a bound that is more than kMostAhead beyond the time of day, for the operator: stamps step back
  /// once. Call before Clocks. Logs a failure.
  void forget();

 private:
  std::string file_;
  struct Outcome {
    std::string trouble;  // the writer's
    std::atomic<bool> has_failed = false;
  };
  std::shared_ptr<Outcome> outcome_ = std::make_shared<Outcome>();
  double last_ = 0;
  ledger::Known ledger_;
};

}  // namespace adit::forward

namespace adit {

template <>
inline constexpr auto store::kMembers<forward::StampFloor::Kept> =
    std::tuple(&forward::StampFloor::Kept::floor, &forward::StampFloor::Kept::wall,
               &forward::StampFloor::Kept::least, &forward::StampFloor::Kept::ledger,
               &forward::StampFloor::Kept::lead, &forward::StampFloor::Kept::overruled);

}  // namespace adit
