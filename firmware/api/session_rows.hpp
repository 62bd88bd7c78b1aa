#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "access/role.hpp"
#include "api/scene.hpp"
#include "codec/row.hpp"

namespace adit::api {

/// Somebody who is logged in.
struct SessionRow {
  std::uint64_t number = 0;
  access::Role role = access::Role::Viewer;
  std::string address, agent;
  Time made = 0, seen = 0;
  bool own = false;

  static const codec::Row kRow;
};

/// What a page asks first.
struct WhoAsks {
  std::optional<access::Role> role;  // nothing: nobody who is known
  std::string csrf;                  // "": none
  bool first_start = false, set_up_open = false;

  static const codec::Row kRow;
};

}  // namespace adit::api
