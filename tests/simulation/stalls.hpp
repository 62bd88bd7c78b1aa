#pragma once

#include "loop/loop.hpp"

namespace adit::simulation {

class World;

/// Times without any traffic between the box and the Command Post, in both directions. Neither end notices:
/// a cable is pulled and put back. One of four runs has one or two of them.
class Stalls {
 public:
  explicit Stalls(World& world) : world_(world) {}
  /// Draws the times. Each may be left out.
  void plan(double trouble_for);
  bool is_on() const;
  loop::Instant ends() const { return ends_; }
  double length() const { return length_; }  // seconds

 private:
  void begin(double length);

  World& world_;
  loop::Instant ends_{};
  double length_ = 0;
};

}  // namespace adit::simulation
