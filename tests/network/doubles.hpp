#pragma once

#include <gtest/gtest.h>

#include <string>

#include "codec/json.hpp"
#include "network/numbers.hpp"

namespace adit::network {

inline settings::Subnet host(const std::string& text) {
  const auto parsed = settings::parse_subnet(text);
  EXPECT_TRUE(parsed) << text;
  return parsed.value_or(settings::Subnet{});
}

/// The usual addresses of a box.
inline Numbers numbers(const std::string& team = "192.168.7.11/24",
                       const std::string& post = "10.100.1.10/24", const std::string& gateway = "") {
  return {.team = host(team), .command_post = {host(post)}, .gateway = settings::ipv4_of(gateway)};
}

/// Without an address of its own on the team's side.
inline Numbers with_mode(Mode mode) {
  Numbers all = numbers();
  all.mode = mode;
  all.team = {};
  return all;
}

inline std::string json_of(const Numbers& all) {
  return codec::to_json(all);
}

}  // namespace adit::network
