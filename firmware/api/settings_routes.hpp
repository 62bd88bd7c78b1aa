#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "api/setup.hpp"
#include "intake/server.hpp"

namespace adit::api {

/// Settings, tokens and courses, for operators whom Entrance let in: README.md has the routes.
class SettingsRoutes {
 public:
  /// `setup` outlives this.
  explicit SettingsRoutes(Setup& setup) : setup_(setup) {}

  static bool has(std::string_view path);
  /// What a viewer may see, too: no token is in it.
  static bool is_for_viewers(std::string_view path);
  /// Requires has(head.path()).
  std::unique_ptr<intake::BodySink> open(const intake::RequestHead& head,
                                         std::shared_ptr<intake::Responder> responder);

 private:
  using Action = intake::Answer (SettingsRoutes::*)(const std::string& body);
  static Action action_at(std::string_view path);

  intake::Answer shown(std::string_view path) const;
  intake::Answer check(const std::string& body);
  intake::Answer save(const std::string& body);
  intake::Answer set_token(const std::string& body);
  intake::Answer switch_course(const std::string& body);
  /// Answers with what changes.
  intake::Answer apply(const settings::Settings& next);

  Setup& setup_;
};

}  // namespace adit::api
