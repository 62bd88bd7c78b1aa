#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "panel/panel.hpp"
#include "settings/settings.hpp"

namespace adit::panel {

/// Messages between aditd and adit-panel: one packet each, as text, at most this many bytes.
inline constexpr std::size_t kLongestMessage = 1024;

/// "lit 1100": aditd is well and wants these lights. Sent at each change and repeatedly.
struct ToLight {
  Lit lit{};
};
/// "end": aditd ends by itself. The lights become dark.
struct ToEnd {};
/// "panel {...}": the lines from the settings, in the format of a board's file, with all members.
struct ToUse {
  settings::Panel panel;
};
using Message = std::variant<ToLight, ToEnd, ToUse>;

std::string message_of(const ToLight& message);
std::string message_of(const ToEnd& message);
std::string message_of(const ToUse& message);
/// Parses a message of the three kinds. An error says what is wrong.
std::expected<Message, std::string> parse_message(std::string_view text);

/// From adit-panel: "button 1", pressed; "button 0", not pressed; "button gone", it cannot be read and a
/// press is cancelled.
struct ButtonIs {
  std::optional<bool> pressed;  // nullopt: it cannot be read
  friend bool operator==(const ButtonIs&, const ButtonIs&) = default;
};
/// "lights 1": the lights are as requested; "lights 0 panel: line H...": they cannot be set, and why.
struct LightsAre {
  static constexpr std::size_t kLongest = 500;  // characters of `trouble`, all printable ASCII
  std::string trouble;                          // or ""
  friend bool operator==(const LightsAre&, const LightsAre&) = default;
};
using Said = std::variant<ButtonIs, LightsAre>;

std::string message_of(const ButtonIs& said);
/// Shortens `trouble` to kLongest and replaces other characters by "?".
std::string message_of(const LightsAre& said);
/// nullopt: unknown message.
std::optional<Said> parse_said(std::string_view text);

}  // namespace adit::panel
