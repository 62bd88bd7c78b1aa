#pragma once

#include <cstdint>
#include <string>

#include "simulation/random.hpp"

namespace adit::simulation {

constexpr std::int64_t kBadSerials = 30'000;  // those of bad messages begin here

/// A request that the ICD forbids, and what it says of it.
struct BadMessage {
  std::string what;  // is bad: "a pose without its position"
  std::string path;
  int status = 422;  // that its sender hears (ICD 4.1)
  std::string request;
};

/// One of them, drawn; its serial is in it where it has room for one.
BadMessage bad_message(Random& random, std::int64_t serial);

}  // namespace adit::simulation
