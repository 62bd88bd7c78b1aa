#pragma once

#include <array>
#include <memory>
#include <optional>

#include "loop/loop.hpp"
#include "panel/panel.hpp"

namespace adit::gateway {

/// Shows conditions on the panel: blinking is timed by the loop, which is woken only while something blinks.
class Lights {
 public:
  Lights(loop::Loop& loop, std::unique_ptr<panel::Lines> lines);

  void show(const panel::Condition& condition);
  /// All lights show panel::kIdentify for so long from now on, whatever the condition.
  void identify(loop::Duration length);
  /// For how much longer they do; nothing: they do not.
  std::optional<loop::Duration> identifying() const;
  const panel::Lights& shown() const { return shown_; }

 private:
  void paint();

  loop::Loop& loop_;
  std::unique_ptr<panel::Lines> lines_;
  loop::Instant began_;
  loop::Source tick_;
  panel::Lights condition_{}, shown_{};
  loop::Instant identify_until_{};
  std::array<bool, panel::kLights.size()> lit_{};
  bool painted_ = false;
  bool broken_ = false;
};

}  // namespace adit::gateway
