#pragma once

#include <cstdint>
#include <string>

#include "simulation/random.hpp"

namespace adit::simulation {

constexpr std::int64_t kBadSerials = 30'000;  // serials of bad messages begin here

/// A request that the ICD forbids, and the status that the ICD gives it.
struct BadMessage {
  std::string what;  // the fault: "a pose without its position"
  std::string path;
  int status = 422;  // expected answer (ICD 4.1)
  std::string request;
};

/// A drawn bad message. It contains the serial if it has a field for one.
BadMessage bad_message(Random& random, std::int64_t serial);

}  // namespace adit::simulation
