#pragma once

#include <string>
#include <vector>

#include "api/setup.hpp"
#include "settings/written.hpp"

namespace adit::api {

/// The JSON of /adit/settings: README.md names the members.
std::string write_setup(const Setup& setup);

/// {"errors": [...], "changes": [...], "warnings": [...]}
std::string write_check(const std::vector<settings::Error>& errors,
                        const std::vector<settings::Change>& changes,
                        const std::vector<std::string>& warnings);

/// {"changes": [...], "warnings": [...]}
std::string write_changes(const std::vector<settings::Change>& changes,
                          const std::vector<std::string>& warnings);

}  // namespace adit::api
