#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/keys.hpp"
#include "icd/bearer_token.hpp"

namespace adit::api {

/// The valid token in tests of the page.
inline icd::BearerToken token(std::string_view text = "team-1") {
  return *icd::BearerToken::parse(text);
}

/// Passwords in plain text. Checks them when the test calls for it.
struct FakeKeys final : Keys {
  const std::string& unread() const override { return unread_; }
  bool first_start() const override { return !operator_; }
  bool is_code(std::string_view presented) const override { return first_start() && presented == "12345678"; }
  bool set_up_open() const override { return set_up; }
  bool is_operator_at_box() const override { return at_box; }
  void check(std::string password, std::string,
             std::function<void(std::optional<access::Role>)> done) override {
    ++checked;
    std::optional<access::Role> role;
    if (password == viewer) role = access::Role::Viewer;
    if (password == operator_) role = access::Role::Operator;
    later([role, done = std::move(done)] { done(role); });
  }
  void set(access::Role role, std::optional<std::string> password,
           std::function<void(icd::Checked<void>)> done) override {
    (role == access::Role::Operator ? operator_ : viewer) = std::move(password);
    if (role == access::Role::Operator) set_up = false;
    later([done = std::move(done)] { done({}); });
  }
  access::Sessions& sessions() override { return sessions_; }
  access::Devices& devices() override { return devices_; }
  access::Secret draw() override { return {++drawn}; }

  void later(std::function<void()> answer) {
    if (slow) {
      waiting.push_back(std::move(answer));
    } else {
      answer();
    }
  }
  void answer_all() {
    for (const auto& answer : std::exchange(waiting, {})) answer();
  }

  std::optional<std::string> operator_ = "correct horse", viewer = "look, do not touch";
  std::string unread_;
  bool set_up = false, at_box = false;
  bool slow = false;
  std::vector<std::function<void()>> waiting;
  int checked = 0;
  std::uint8_t drawn = 0;
  access::Sessions sessions_;
  access::Devices devices_;
};

}  // namespace adit::api
