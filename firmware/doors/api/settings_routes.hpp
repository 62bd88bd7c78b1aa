#pragma once

#include <string>

#include "api/setup.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Settings, tokens and courses. Routes: README.md.
class SettingsRoutes {
 public:
  /// `setup` must outlive this object.
  explicit SettingsRoutes(Setup& setup) : setup_(setup) {}

  intake::Answer shown() const;
  intake::Answer exported() const;
  intake::Answer check(const std::string& body) const;
  intake::Answer save(const std::string& body);
  intake::Answer set_token(const std::string& body);
  intake::Answer switch_course(const std::string& name);

 private:
  /// Answers with the changes.
  intake::Answer apply(const settings::Settings& next);

  Setup& setup_;
};

}  // namespace adit::api
