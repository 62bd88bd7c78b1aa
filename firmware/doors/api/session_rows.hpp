#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "access/role.hpp"
#include "api/scene.hpp"
#include "codec/row.hpp"

namespace adit::api {

/// A logged-in user.
struct SessionRow {
  std::uint64_t number = 0;
  access::Role role = access::Role::Viewer;
  std::string address, agent;
  Time made = 0, seen = 0;
  bool own = false;

  static const codec::Row kRow;
};

/// The first question of a page.
struct SessionView {
  std::optional<access::Role> role;  // nullopt: not logged in
  std::string csrf;                  // "": none
  bool first_start = false, set_up_open = false;

  static const codec::Row kRow;
};

}  // namespace adit::api
