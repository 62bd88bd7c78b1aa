#include "settings/saved.hpp"

namespace adit::settings {

std::vector<std::string> token_names(const Settings& settings) {
  std::vector<std::string> names = {"scoring", "mapping", "team"};
  for (const Course& course : settings.courses) {
    names.push_back("course." + course.name + ".scoring");
    names.push_back("course." + course.name + ".mapping");
  }
  return names;
}

}  // namespace adit::settings
