#pragma once

#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "panel/button.hpp"
#include "panel/messages.hpp"
#include "panel/painter.hpp"
#include "panel/panel.hpp"
#include "panel/reopened.hpp"

namespace adit::panel {

/// Decides the lights from the messages of an aditd: its own lights while it is well, the fault if it is not,
/// and dark after it ended by itself. It reads no clock: each call gets the time, which never runs backward.
class HeartbeatMonitor {
 public:
  /// aditd sends its lights at least once a second. After kSilence without them it hangs.
  static constexpr Milliseconds kSilence{1800};
  /// A start may take this long, from the constructor or from the connection. It is systemd's limit.
  static constexpr std::chrono::minutes kStart{1};

  explicit HeartbeatMonitor(Instant now) : since_(now) {}

  /// It connected, sent its lights, announced its end, or lost its connection.
  void on_contact(Instant now);
  void on_lights(const Lit& lit, Instant now);
  void on_ended(Instant now) { enter(Phase::Ended, now); }
  void on_gone(Instant now);

  /// The present lights, and when to ask again at the latest.
  Frame frame(Instant now) const;
  bool is_faulty(Instant now) const { return fault_start(now).has_value(); }

 private:
  enum class Phase : std::uint8_t { Awaited, Well, Ended, Dead };
  void enter(Phase phase, Instant now);
  std::optional<Instant> fault_start(Instant now) const;

  Phase phase_ = Phase::Awaited;
  Instant since_;  // start of the phase; of Well: the last lights
  Lit lit_{};
};

/// Holds the panel's lines for aditd and watches aditd: the core of adit-panel. It serves one aditd at a
/// time, the one that connected last. It reports the button's level and lights that cannot be set.
class Keeper {
 public:
  struct Callbacks {
    std::function<PanelDevices(const settings::Panel&)> open;
    std::function<void(const std::string&)> complain;  // gets a sentence for the log
  };

  /// `boards` has priority over the panel that aditd names. nullopt: no panel until aditd names one.
  Keeper(loop::Loop& loop, loop::FileDescriptor listening, std::optional<settings::Panel> boards,
         Callbacks world);
  Keeper(const Keeper&) = delete;
  Keeper& operator=(const Keeper&) = delete;

 private:
  /// The connected aditd, and the last reports to it.
  struct Client {
    loop::FileDescriptor socket;
    bool owns_press = false;  // the present press began after it connected
    ButtonState told_button{false};
    LightsState told_lights = {};
    loop::Source messages = {};  // ended before the socket is closed
  };

  void accept();
  void read_messages();
  void handle(std::string_view message);
  void handle(const LightRequest& message);
  void handle(const EndRequest& /*message*/) { watched_.on_ended(loop_.now()); }
  void handle(const LinesRequest& message) {
    if (!knows_board_ && used_ != message.panel) configure(message.panel);
  }
  void disconnect();
  void configure(const settings::Panel& panel);
  void watch_button();
  void check_button();
  void log_button(const std::expected<bool, std::string>& level);
  void show();
  void paint();
  void send_changes();
  void send_message(const std::string& message);

  loop::Loop& loop_;
  Callbacks world_;
  HeartbeatMonitor watched_;
  const bool knows_board_;
  std::optional<settings::Panel> used_;
  Painter painter_;
  std::unique_ptr<ButtonLine> button_;   // null: there is none
  std::optional<bool> pressed_ = false;  // the line's level; nullopt: it cannot be read
  bool complained_ = false;              // a wrong message of aditd was logged
  bool button_broken_ = false;           // the button cannot be read; this was logged
  std::optional<Client> client_;
  loop::FileDescriptor listening_;
  loop::Source tick_, edges_, callers_;  // ended before their descriptors are closed
};

}  // namespace adit::panel
