#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/setup.hpp"
#include "settings/sample.hpp"
#include "settings/written.hpp"

namespace adit::api {

inline constexpr const char* kCourses =
    R"(, "courses": [{"name": "A", "scoring": {"address": "10.100.2.200", "port": 8000},)"
    R"( "mapping": {"address": "10.100.2.201", "port": 8000}}])";

/// Records requests, and rejects them if the test says so.
struct FakeSetup : Setup {
  const settings::Settings& settings() const override { return now; }
  bool is_saved() const override { return false; }
  bool applying() const override { return is_applying; }
  const std::string& trouble() const override { return why; }
  std::vector<TokenRow> tokens() const override {
    return {{"scoring", true, "odd"}, {"course.A.mapping", false}};
  }
  std::vector<std::string> warnings(const settings::Settings& next) const override {
    if (next.command_post.course != now.command_post.course) return {"reports go elsewhere"};
    if (next.team.require_token) return {};
    return {"no token is asked for"};
  }
  icd::Checked<void> save(const settings::Settings& next) override {
    if (refusal) return std::unexpected(*refusal);
    ++saves;
    is_applying = !settings::changes(now, next).empty();
    now = next;
    return {};
  }
  icd::Checked<void> set_token(const std::string& name,
                               const std::optional<icd::BearerToken>& token) override {
    if (refusal) return std::unexpected(*refusal);
    set.emplace_back(name, token ? token->reveal() : "removed");
    return {};
  }
  icd::Checked<void> reset() override {
    if (refusal) return std::unexpected(*refusal);
    ++resets;
    return {};
  }

  settings::Settings now = settings::parse(settings::sample("", "", kCourses)).value();
  std::optional<icd::Refusal> refusal;
  std::vector<std::pair<std::string, std::string>> set;
  std::string why;
  int saves = 0, resets = 0;
  bool is_applying = false;
};

}  // namespace adit::api
