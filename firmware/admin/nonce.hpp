#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "host/random.hpp"
#include "network/messages.hpp"

namespace adit::admin {

/// Of a request to a program that runs as root: never the same twice.
inline std::string draw_nonce() {
  std::array<std::uint8_t, network::kNonceBytes> random{};
  host::fill_random(random);
  return network::nonce_of(random);
}

}  // namespace adit::admin
