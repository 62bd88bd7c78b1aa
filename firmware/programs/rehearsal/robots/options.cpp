#include "rehearsal/robots/options.hpp"

#include "command_line/program.hpp"
#include "rehearsal/robots/maps/map_file.hpp"

namespace adit::robots {
namespace {

using command_line::number;

std::expected<std::vector<std::filesystem::path>, std::string> maps_under(const std::string& folder) {
  auto maps = find_maps(folder);
  if (maps && maps->empty()) return std::unexpected("no .pgm, .pcd or .ply under " + folder);
  return maps;
}

/// Also names what contradicts itself if help is wanted, so that --help checks a command line.
std::expected<Options, std::string> complete(Options options) {
  if (options.robots == 0 && options.maps.empty()) return std::unexpected("--robots 0: needs --maps");
  if (options.help || options.version) return options;
  if (options.generate_only) {
    if (options.truth.empty()) return std::unexpected("--generate-only: needs --truth CSV");
    return options;
  }
  if (options.post.port == 0) return std::unexpected("--post http://ADDR:PORT: is needed");
  if (options.secrets.empty()) return std::unexpected("--secrets DIR: is needed");
  if (options.scoring.port == 0) options.scoring = options.post;
  return options;
}

}  // namespace

command_line::Program command_line_of(Options& options) {
  constexpr double kLongest = 1e6;  // seconds
  constexpr double kMostHz = 10, kMostMegabytes = 100;
  return {
      .name = "adit-robots",
      .usage = "--post URL --secrets DIR | --generate-only --truth CSV",
      .about =
          "Simulated team of robots that explores a generated cave and posts the messages of real teams.",
      .rows =
          {{"--post", "URL", "address to post to: Adit, as http://ADDR:PORT",
            parsed_value<parse_url>(options.post)},
           {"--scoring", "URL", "another address for reports and status, to use a Command Post without Adit",
            parsed_value<parse_url>(options.scoring)},
           {"--control", "URL",
            "control port of adit-rehearsal: send it the amounts posted, and print the age of the maps at "
            "arrival",
            parsed_value<parse_url>(options.control)},
           {"--secrets", "DIR", "directory of the team's token: team.token", &options.secrets},
           {"--robots", "N", "number of robots, 0 to 50 (3)", number<0, 50>(options.robots)},
           {"--style", "STYLE",
            "cbor, cbor-plain, cbor-body-gzip, json-base64, json-array, ros, browser or mixed: format of the "
            "messages; mixed: one format after the other, robot by robot (mixed)",
            parsed_value<TeamStyle::parse>(options.style)},
           {"--grids", "FORMS",
            "whole, drifting (whole, with an origin that is off by millimetres), rolling (10 m around the "
            "robot), tiles, none: form of the grids; of several, separated by commas, each robot takes the "
            "next "
            "(whole)",
            parsed_value<parse_grid_forms>(options.offers.grids)},
           {"--grid-hz", "HZ", "grids per second from each robot (1)",
            number<0.01, kMostHz>(options.offers.grid_hz)},
           {"--grid-mb", "MB", "size in MB of a grid of the whole cave, reached with smaller cells (0.15)",
            number<0.0, kMostMegabytes>(options.offers.grid_mb)},
           {"--clouds", "FORMS",
            "differential, whole, none: form of the clouds; several as for --grids (differential)",
            parsed_value<parse_cloud_forms>(options.offers.clouds)},
           {"--cloud-hz", "HZ", "clouds per second from each robot (1, 2 and 0.5 in turn)",
            number<0.01, kMostHz>(options.offers.cloud_hz)},
           {"--cloud-mb", "MB",
            "minimum size in MB of a cloud, reached with more points (as measured in the cave)",
            number<0.0, kMostMegabytes>(options.offers.cloud_mb)},
           {"--maps", "DIR",
            "also post the map files under DIR (.pgm with .yaml, .pcd, .ply), as a robot named replay",
            parsed_value<maps_under>(options.maps)},
           {"--for", "SECONDS", "stop after this time (default: at SIGINT or SIGTERM)",
            number<0.0, kLongest>(options.run_for)},
           {"--stop-when-posted", "",
            "stop when one message of every kind was accepted and every map file was posted",
            &options.stop_when_posted},
           {"--seed", "N", "seed of the cave and of the walk through it (1)",
            number<0UL, UINT64_MAX>(options.seed)},
           {"--truth", "CSV", "write the artifacts of the cave to this file, as type,x,y,z", &options.truth},
           {"--generate-only", "", "write the file of --truth and exit", &options.generate_only},
           {"--speed", "X", "speed of the robots, in units of 2 m/s (1)", number<0.1, 20.0>(options.speed)},
           {"--quiet", "", "print only the final summary", &options.quiet}},
      .ending =
          "Exit code: 0 if at least one message of every kind was accepted and no message was rejected, "
          "except with 429 (too many requests).",
  };
}

std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  auto options = command_line::read(command_line_of, arguments);
  return options ? complete(*std::move(options)) : options;
}

}  // namespace adit::robots
