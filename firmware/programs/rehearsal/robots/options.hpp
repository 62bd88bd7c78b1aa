#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "command_line/read.hpp"
#include "rehearsal/common.hpp"
#include "rehearsal/robots/messages.hpp"
#include "rehearsal/robots/robot.hpp"

namespace adit::robots {

/// The command line of adit-robots.
struct Options {
  Address post;
  Address scoring;  // the same as `post` unless it is given
  std::optional<Address> control;
  std::string secrets;
  std::size_t robots = 3;
  TeamStyle style;
  MapOffers offers;
  std::vector<std::filesystem::path> maps;  // files that the robot `replay` posts
  std::string truth;                        // "": not written
  std::optional<std::chrono::duration<double>> run_for;
  std::uint64_t seed = 1;
  double speed = 1;
  bool quiet = false, stop_when_posted = false, generate_only = false, help = false, version = false;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);

/// Or a sentence that names the argument.
[[gnu::cold]] std::expected<Options, std::string> parse_options(std::span<const char* const> arguments);

}  // namespace adit::robots
