#pragma once

#include <filesystem>
#include <regex>
#include <set>
#include <string>

#include "alarms/alike.hpp"
#include "project_files.hpp"

namespace adit::alarms {

/// "no_token" of "no_token:scoring"
inline std::string kind_of(const std::string& id) {
  return id.substr(0, id.find(':'));
}

/// The kinds of conditions, from the text of the rules: `.id = "cable_out:" + side`, or a row of a table.
inline std::set<std::string> kinds() {
  static const std::regex kId(R"re((?:\bid = |EndpointFault::\w+, |\n    \{)"([a-z_]+)[":])re");
  std::set<std::string> kinds;
  for (const auto& file : std::filesystem::directory_iterator(project_file("firmware/rules/alarms"))) {
    const std::string name = file.path().filename();
    if (!name.ends_with("_conditions.cpp")) continue;
    const std::string text = project_text("firmware/rules/alarms/" + name);
    for (std::sregex_iterator found(text.begin(), text.end(), kId), end; found != end; ++found)
      kinds.insert((*found)[1]);
  }
  return kinds;
}

}  // namespace adit::alarms
