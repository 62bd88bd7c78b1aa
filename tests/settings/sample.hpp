#pragma once

#include <string>

#include "settings/settings.hpp"

namespace adit::settings {

/// The smallest valid settings file, with additional members in each object. `at_command_post`, `at_team`
/// and `at_top` begin with a comma if they are not empty.
inline std::string sample(const std::string& at_command_post = "", const std::string& at_team = "",
                          const std::string& at_top = "") {
  return R"({"version": 1, "command_post": {"scoring": {"address": "10.100.1.200", "port": 8000},)"
         R"("mapping": {"address": "10.100.1.201", "port": 8001})" +
         at_command_post + R"(}, "team": {"listen": [{"address": "0.0.0.0", "port": 8000}])" + at_team + "}" +
         at_top + "}";
}

/// Default settings with an item in each list.
inline Settings with_an_item_of_each() {
  Settings settings;
  settings.courses.resize(1);
  settings.team.listen.resize(1);
  settings.robots.resize(1);
  return settings;
}

}  // namespace adit::settings
