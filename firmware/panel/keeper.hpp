#pragma once

#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "panel/held.hpp"
#include "panel/messages.hpp"
#include "panel/painter.hpp"
#include "panel/watched.hpp"

namespace adit::panel {

/// Holds the lines of the panel for aditd, and watches it: adit-panel. One aditd at a time is heard, the one
/// that connected last, and is told of the button, and of lights that cannot be set.
class Keeper {
 public:
  struct World {
    std::function<Held(const settings::Panel&)> open;
    std::function<void(const std::string&)> complain;  // a sentence, for the log
  };

  /// `boards` counts before what aditd tells of the lines; nothing: they are not known before.
  Keeper(loop::Loop& loop, loop::FileDescriptor listening, std::optional<settings::Panel> boards,
         World world);
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

 private:
  void accept();
  void hear();
  void take(std::string_view message);
  void take(const ToLight& message);
  void take(const ToEnd& message);
  void take(const ToUse& message);
  void lose();
  void use(const settings::Panel& panel);
  void watch_button();
  void look_at_button();
  void log_button(const std::expected<bool, std::string>& level);
  ButtonIs button_for_him() const;
  void show();
  void paint();
  void tell_what_is_new();
  void tell(const std::string& message);

  loop::Loop& loop_;
  World world_;
  Watched watched_;
  const bool knows_board_;
  std::optional<settings::Panel> used_;
  Painter painter_;
  std::unique_ptr<ButtonLine> button_;   // null: there is none
  std::optional<bool> pressed_ = false;  // by what the line says; nothing: it cannot be read
  bool is_for_him_ = false;              // the press began after whoever is heard had connected
  ButtonIs told_button_{false};          // as he was told
  LightsAre told_lights_;                // as he was told
  bool complained_ = false;              // of what he tells
  bool button_broken_ = false;           // which was logged
  loop::FileDescriptor listening_, client_;
  loop::Source tick_, edges_, callers_, words_;  // ended before their descriptors are closed
};

}  // namespace adit::panel
