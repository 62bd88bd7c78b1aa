// What aditd and adit-panel tell each other: one packet.
#include "panel/messages.hpp"
#include "target.hpp"

namespace adit::fuzz {

void try_panel(Input text) {
  const auto write = [](const panel::Message& message) {
    return std::visit([](const auto& each) { return panel::message_of(each); }, message);
  };
  settles(text, panel::parse_message, write);
  if (const auto said = panel::parse_report(text))
    require(std::visit([](const auto& each) { return panel::message_of(each); }, *said) == text);
}

}  // namespace adit::fuzz
