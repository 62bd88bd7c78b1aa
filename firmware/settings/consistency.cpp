#include "settings/consistency.hpp"

#include <array>
#include <utility>

namespace adit::settings {
namespace {

std::string item(std::size_t index) {
  return "team.listen[" + std::to_string(index) + "]";
}

void check_listen(const Settings& settings, std::vector<Error>& errors) {
  const auto& listen = settings.team.listen;
  for (std::size_t i = 0; i < listen.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (listen[i].port != 0 && listen[i] == listen[j])
        errors.push_back({item(i), "the same as " + item(j)});
    }
    if (listen[i] == settings.command_post.scoring || listen[i] == settings.command_post.mapping) {
      errors.push_back({item(i), "the same as an endpoint of the Command Post; Adit would post to itself"});
    }
  }
}

void check_connections(const Team& team, std::vector<Error>& errors) {
  if (team.connections_per_address <= team.connections) return;
  errors.push_back({"team.connections_per_address", "expected at most team.connections, " +
                                                        std::to_string(team.connections) + ", got " +
                                                        std::to_string(team.connections_per_address)});
}

void check_panel(const Panel& panel, std::vector<Error>& errors) {
  const std::array<std::pair<const char*, const std::string&>, 4> lines = {
      {{"panel.health", panel.health},
       {"panel.scoring", panel.scoring},
       {"panel.mapping", panel.mapping},
       {"panel.attention", panel.attention}}};
  bool named = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& [path, line] = lines[i];
    if (line.empty()) continue;
    named = true;
    if (panel.chip.empty()) errors.push_back({path, "names a line, but panel.chip names no chip"});
    for (std::size_t j = 0; j < i; ++j) {
      if (line == lines[j].second)
        errors.push_back({path, std::string("the same line as ") + lines[j].first});
    }
  }
  if (!panel.chip.empty() && !named)
    errors.push_back({"panel.chip", "names a chip, but no light has a line"});
}

}  // namespace

std::vector<Error> contradictions(const Settings& settings) {
  std::vector<Error> errors;
  check_listen(settings, errors);
  check_connections(settings.team, errors);
  check_panel(settings.panel, errors);
  return errors;
}

}  // namespace adit::settings
