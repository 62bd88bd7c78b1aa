#pragma once

#include "access/sessions.hpp"

namespace adit::access {

constexpr Instant kStart{std::chrono::hours(1000)};

}  // namespace adit::access
