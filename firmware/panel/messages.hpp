#pragma once

#include <expected>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "panel/panel.hpp"
#include "settings/settings.hpp"

namespace adit::panel {

/// What aditd and adit-panel tell each other, a packet each, in words. None is longer.
inline constexpr std::size_t kLongestMessage = 1024;

/// "lit 1100": the lights are to be lit so, and aditd is well; told at each change, and over and over.
struct ToLight {
  Lit lit{};
};
/// "end": aditd ends by itself, so that the lights are to be dark.
struct ToEnd {};
/// "panel {...}": where the lines are, as the settings say, in the form of a board's file. All its members
/// are told.
struct ToUse {
  settings::Panel panel;
};
using Message = std::variant<ToLight, ToEnd, ToUse>;

std::string message_of(const ToLight& message);
std::string message_of(const ToEnd& message);
std::string message_of(const ToUse& message);
/// As strictly as they are written; an error says what is wrong, without what came.
std::expected<Message, std::string> parse_message(std::string_view text);

/// The other way: "button 1", it is pressed; "button 0", it is not; "button gone", it cannot be read, and
/// what was pressed comes to nothing.
struct ButtonIs {
  std::optional<bool> pressed;  // nothing: it cannot be read
  friend bool operator==(const ButtonIs&, const ButtonIs&) = default;
};
/// "lights 1": they are as they were told to be; "lights 0 panel: line H...": they cannot be set, and why.
struct LightsAre {
  static constexpr std::size_t kLongest =
      500;              // characters of the trouble, which are printable ones of ASCII
  std::string trouble;  // or ""
  friend bool operator==(const LightsAre&, const LightsAre&) = default;
};
using Said = std::variant<ButtonIs, LightsAre>;

std::string message_of(const ButtonIs& said);
/// A trouble that could not be told as it is, is cut.
std::string message_of(const LightsAre& said);
/// Nothing: it is no such message.
std::optional<Said> parse_said(std::string_view text);

}  // namespace adit::panel
