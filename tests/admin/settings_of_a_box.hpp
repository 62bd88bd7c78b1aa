#pragma once

namespace adit::admin {

/// Minimal valid settings.
inline constexpr const char* kSettings = R"({
  "version": 1,
  "command_post": {"scoring": {"address": "10.100.1.200", "port": 8000},
                   "mapping": {"address": "10.100.1.201", "port": 8000}, "interface": "darpa0"},
  "team": {"interface": "team0", "listen": [{"address": "192.168.7.11", "port": 8000}]}})";

}  // namespace adit::admin
