#pragma once

#include <string>

#include "api/settings_rows.hpp"
#include "api/setup.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Settings, tokens and courses. Routes: README.md.
namespace settings_routes {

intake::Answer export_settings(const Setup& setup);
icd::Checked<CheckView> check(const Setup& setup, const std::string& body);
icd::Checked<intake::Answer> save(Setup& setup, const std::string& body);
icd::Checked<intake::Answer> set_token(Setup& setup, const std::string& body);
intake::Answer switch_course(Setup& setup, const std::string& name);

}  // namespace settings_routes
}  // namespace adit::api
