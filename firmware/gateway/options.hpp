#pragma once

#include <expected>
#include <span>
#include <string>

namespace adit::gateway {

/// aditd's command line.
struct Options {
  std::string settings, secrets, state;
  std::string network = "/run/adit-network", update = "/run/adit-update";
  std::string board;  // "": none
  std::string notices = "/run/adit-notices";
  bool help = false, version = false;
};

extern const char* const kUsage;

/// What is wrong names the word it is about.
std::expected<Options, std::string> parse_options(std::span<char* const> arguments);

}  // namespace adit::gateway
