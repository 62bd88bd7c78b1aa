#pragma once

#include <memory>
#include <optional>
#include <string>

#include "lanes/stamps.hpp"

namespace adit::forward {

/// Keeps stamps from running backward over a start of the machine (promise 5): a box without a clock of its
/// own begins each at about the same moment. A file in the state folder says above what no stamp has been
/// given out; it is ahead of them, so that it need be written only now and then, and nobody waits for it.
class StampFloor {
 public:
  static constexpr const char* kFile = "stamps";
  static constexpr double kEvery = 10;  // seconds
  /// Stamps are up to kJump ahead of now, and a disk may be slow.
  static constexpr double kAhead = lanes::StampShift::kJump + kEvery + 15;

  explicit StampFloor(const std::string& state_folder) : file_(state_folder + '/' + kFile) {}

  /// Seconds since 1970; 0 where nothing is known. What is wrong with the file is logged.
  double read() const;

  /// What is to be written by now, if anything.
  std::optional<double> due(double now);
  /// Safe to be called on a worker, one call after the other, and on copies. What cannot be written is
  /// logged, once until it can or fails otherwise.
  void write(double floor);

 private:
  std::string file_;
  std::shared_ptr<std::string> trouble_ = std::make_shared<std::string>();  // the writer's
  double next_ = 0;
};

}  // namespace adit::forward
