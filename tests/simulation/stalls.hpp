#pragma once

#include "loop/loop.hpp"

namespace adit::simulation {

class World;

/// Times in which nothing gets through between the box and the Command Post, in either direction, and no end
/// hears of it: a cable that is pulled and put back. In one of four runs, one or two of them.
class Stalls {
 public:
  explicit Stalls(World& world) : world_(world) {}
  /// Draws when they come. Each may be left out.
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
