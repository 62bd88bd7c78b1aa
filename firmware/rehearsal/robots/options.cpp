#include "rehearsal/robots/options.hpp"

#include <algorithm>

#include "command_line/number.hpp"
#include "rehearsal/robots/maps/bytes.hpp"

namespace adit::robots {

namespace {

using command_line::number;
using command_line::take;
using command_line::Wrong;

Wrong take_url(Endpoint& into, const std::string& text) {
  auto endpoint = parse_url(text);
  if (!endpoint) return endpoint.error();
  into = *std::move(endpoint);
  return std::nullopt;
}

Wrong take_style(TeamStyle& into, const std::string& text) {
  const auto style = TeamStyle::parse(text);
  if (!style) return "no style is named '" + text + "'";
  into = *style;
  return std::nullopt;
}

std::expected<Options, std::string> complete(Options options) {
  if (options.help) return options;
  if (options.generate_only) {
    if (options.truth.empty()) return std::unexpected("--generate-only: needs --truth CSV");
    return options;
  }
  if (options.post.port == 0) return std::unexpected("--post http://ADDR:PORT: is needed");
  if (options.secrets.empty()) return std::unexpected("--secrets DIR: is needed");
  if (options.robots == 0 && options.maps.empty())
    return std::unexpected("--robots 0: has nothing to post without --maps");
  if (options.scoring.port == 0) options.scoring = options.post;
  return options;
}

}  // namespace

command_line::Program command_line_of(Options& options) {
  constexpr double kLongest = 1e6;  // seconds
  return {
      .name = "adit-robots",
      .usage = "--post URL --secrets DIR | --generate-only --truth CSV",
      .about = "A simulated team that explores a generated cave and posts what real teams post.",
      .rows = {{"--post", "URL", "where everything goes: Adit, http://ADDR:PORT",
                take<take_url>(options.post)},
               {"--scoring", "URL",
                "where reports and status go instead, to speak to a Command Post without Adit",
                take<take_url>(options.scoring)},
               {"--secrets", "DIR", "team.token in it is what the team presents", &options.secrets},
               {"--robots", "N", "how many explore, 0 to 30 (3)", number<0, 30>(options.robots)},
               {"--style", "STYLE",
                "cbor, cbor-body-gzip, json-base64, json-array, ros, browser, or mixed: each robot the next "
                "one (mixed)",
                take<take_style>(options.style)},
               {"--maps", "DIR",
                "also post the map files under DIR (.pgm with .yaml, .pcd, .ply) as a robot `replay`",
                &options.maps},
               {"--for", "SECONDS", "how long; without it, until SIGINT or SIGTERM",
                number<0.0, kLongest>(options.run_for)},
               {"--stop-when-posted", "",
                "stop as soon as one of every kind was accepted, and every map file was posted",
                &options.stop_when_posted},
               {"--seed", "N", "which cave, and which walk through it (1)",
                number<0UL, UINT64_MAX>(options.seed)},
               {"--truth", "CSV", "write the cave's artifacts there, as type,x,y,z", &options.truth},
               {"--generate-only", "", "write that, and do no more", &options.generate_only},
               {"--speed", "X", "robots walk 2 X metres a second (1)", number<0.1, 20.0>(options.speed)},
               {"--quiet", "", "print the last summary alone", &options.quiet},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Ends with 0 if one of every kind at least was accepted and nothing was refused but for going too "
          "fast (429).",
  };
}

std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  auto options = command_line::read(command_line_of, arguments);
  return options ? complete(*std::move(options)) : options;
}

std::expected<std::string, std::string> read_team_token(const std::filesystem::path& secrets) {
  const std::filesystem::path file = secrets / "team.token";
  auto token = read_file(file);
  if (!token) return std::unexpected(file.string() + ": " + token.error());
  while (!token->empty() && (token->back() == '\n' || token->back() == '\r')) token->pop_back();
  const bool visible = std::ranges::all_of(*token, [](char c) { return c > ' ' && c <= '~'; });
  if (token->empty() || !visible)
    return std::unexpected(file.string() + ": expected one line of visible characters");
  return token;
}

}  // namespace adit::robots
