#include "settings/restarts.hpp"

#include <string_view>

#include "settings/written.hpp"

namespace adit::settings {
namespace {

struct Row {
  std::string_view begins;  // beginning of a setting's path
  Restarts restarts;
};

constexpr Row kRows[] = {
    {"team.listen", {.listeners = true}},
    {"team.interface", {.listeners = true}},
    {"team.connections", {.listeners = true}},  // and team.connections_per_address
    {"command_post.scoring.", {.scoring = true}},
    {"command_post.mapping.", {.mapping = true}},
    {"command_post.interface", {.scoring = true, .mapping = true}},
    {"command_post.budget_mbit", {.mapping = true}},
    {"command_post.timeouts.connect_ms", {.scoring = true, .mapping = true}},
    {"command_post.timeouts.scoring_answer_ms", {.scoring = true}},
    {"command_post.timeouts.mapping_answer_ms", {.mapping = true}},
    {"panel.", {.panel = true}},
};

}  // namespace

Restarts restarts_by(const Settings& running, const Settings& next) {
  Restarts all;
  for (const Change& change : changes(running, next)) {
    for (const auto& [begins, restarts] : kRows) {
      if (!change.path.starts_with(begins)) continue;
      all.listeners = all.listeners || restarts.listeners;
      all.scoring = all.scoring || restarts.scoring;
      all.mapping = all.mapping || restarts.mapping;
      all.panel = all.panel || restarts.panel;
    }
  }
  return all;
}

}  // namespace adit::settings
