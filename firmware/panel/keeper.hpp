#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "panel/lines.hpp"
#include "panel/messages.hpp"
#include "panel/watched.hpp"

namespace adit::panel {

/// Holds the lines of the panel for aditd, and watches it: adit-panel. One aditd at a time is heard, the one
/// that connected last.
class Keeper {
 public:
  struct Held {
    std::unique_ptr<Lines> lines;        // null: they cannot be had
    std::unique_ptr<ButtonLine> button;  // null: there is none
  };
  struct World {
    std::function<Held(const settings::Panel&)> open;  // says itself what cannot be had
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
  void tell_of_button();
  void paint();

  loop::Loop& loop_;
  World world_;
  Watched watched_;
  const bool knows_board_;
  std::optional<settings::Panel> used_;
  Held held_;
  std::optional<Lit> shown_;
  bool pressed_ = false;     // by what the line says
  bool is_for_him_ = false;  // the press began after whoever is heard had connected
  bool complained_ = false;  // of what he tells
  bool broken_ = false;      // the lights cannot be set, which was told
  loop::FileDescriptor listening_, client_;
  loop::Source tick_, edges_, callers_, words_;  // ended before their descriptors are closed
};

}  // namespace adit::panel
