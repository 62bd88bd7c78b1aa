#pragma once

#include <array>
#include <memory>

#include "loop/loop.hpp"
#include "panel/panel.hpp"

namespace adit::gateway {

/// Shows conditions on the panel: blinking is timed by the loop, which is woken only while something blinks.
class Lights {
 public:
  Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines);

  void show(const panel::Condition& condition);
  const panel::Lights& shown() const { return shown_; }

 private:
  void paint();

  loop::Loop& loop_;
  std::unique_ptr<panel::Lines> lines_;
  loop::Instant began_;
  loop::Source tick_;
  panel::Lights shown_{};
  std::array<bool, panel::kLights.size()> lit_{};
  bool painted_ = false;
  bool broken_ = false;
};

}  // namespace adit::gateway
