#pragma once

#include <string>

namespace adit::settings {

/// The least settings file that works, with more members in each of its objects: `at_command_post` and
/// `at_team` begin with a comma where they are not empty, and so does `at_top`.
inline std::string sample(const std::string& at_command_post = "", const std::string& at_team = "",
                          const std::string& at_top = "") {
  return R"({"version": 1, "command_post": {"scoring": {"address": "10.100.1.200", "port": 8000},)"
         R"("mapping": {"address": "10.100.1.201", "port": 8001})" +
         at_command_post + R"(}, "team": {"listen": [{"address": "0.0.0.0", "port": 8000}])" + at_team + "}" +
         at_top + "}";
}

}  // namespace adit::settings
