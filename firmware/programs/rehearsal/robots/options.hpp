#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <filesystem>
#include <optional>
#include <string>

#include "command_line/read.hpp"
#include "rehearsal/robots/client.hpp"
#include "rehearsal/robots/map_maker.hpp"
#include "rehearsal/robots/messages.hpp"

namespace adit::robots {

/// The command line of adit-robots.
struct Options {
  Endpoint post;
  Endpoint scoring;  // the same as `post` unless it is given
  std::optional<Endpoint> control;
  std::string secrets;
  std::size_t robots = 3;
  TeamStyle style;
  MapOffers offers;
  std::string maps;   // "": none
  std::string truth;  // "": not written
  std::optional<std::chrono::duration<double>> run_for;
  std::uint64_t seed = 1;
  double speed = 1;
  bool quiet = false, stop_when_posted = false, generate_only = false, help = false, version = false;
};

[[gnu::cold]] command_line::Program command_line_of(Options& options);

/// Or a sentence that names the argument.
[[gnu::cold]] std::expected<Options, std::string> parse_options(std::span<const char* const> arguments);

/// What DIR/team.token holds, without the line's end.
std::expected<std::string, std::string> read_team_token(const std::filesystem::path& secrets);

}  // namespace adit::robots
