#include "rehearsal/robots/options.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "rehearsal/robots/maps/bytes.hpp"

namespace adit::robots {

const char* const kUsage =
    R"(adit-robots: a simulated team that explores a generated cave and posts what real teams post

  adit-robots --post http://ADDR:PORT --secrets DIR [options]
  adit-robots --generate-only --truth CSV [--seed N]

  --post URL           where everything goes: Adit
  --scoring URL        where reports and status go instead, to speak to a Command Post without Adit
  --secrets DIR        team.token in it is what the team presents
  --robots N           how many explore, 0 to 30 (3)
  --style STYLE        cbor, cbor-body-gzip, json-base64, json-array, ros, browser, or mixed: each robot the
                       next one (mixed)
  --maps DIR           also post the map files under DIR (.pgm with .yaml, .pcd, .ply) as a robot `replay`
  --for SECONDS        how long; without it, until SIGINT or SIGTERM
  --stop-when-posted   stop as soon as one of every kind was accepted, and every map file was posted
  --seed N             which cave, and which walk through it (1)
  --truth CSV          write the cave's artifacts there, as type,x,y,z
  --generate-only      write that, and do no more
  --speed X            robots walk 2 X metres a second (1)
  --quiet              print the last summary alone

Ends with 0 if one of every kind at least was accepted and nothing was refused but for going too fast (429).
)";

namespace {

using Taken = std::expected<void, std::string>;

Taken take_number(std::string_view text, double low, double high, double& into) {
  const auto number = parse_number<double>(text);
  if (!number || !std::isfinite(*number) || *number < low || *number > high) {
    return std::unexpected("expected a number from " + std::to_string(low) + " to " + std::to_string(high) +
                           ", got '" + std::string(text) + "'");
  }
  into = *number;
  return {};
}

Taken take_whole(std::string_view text, std::uint64_t most, std::uint64_t& into) {
  const auto number = parse_number<std::uint64_t>(text);
  if (!number || *number > most) {
    return std::unexpected("expected a whole number from 0 to " + std::to_string(most) + ", got '" +
                           std::string(text) + "'");
  }
  into = *number;
  return {};
}

Taken take_url(std::string_view text, Endpoint& into) {
  auto endpoint = parse_url(text);
  if (!endpoint) return std::unexpected(endpoint.error());
  into = *std::move(endpoint);
  return {};
}

Taken take_path(std::string_view text, std::filesystem::path& into) {
  if (text.empty()) return std::unexpected("expected a path");
  into = text;
  return {};
}

Taken take_style(std::string_view text, TeamStyle& into) {
  const auto style = TeamStyle::parse(text);
  if (!style) return std::unexpected("no style is named '" + std::string(text) + "'");
  into = *style;
  return {};
}

Taken take_seconds(std::string_view text, std::optional<std::chrono::duration<double>>& into) {
  double seconds = 0;
  Taken taken = take_number(text, 0, 1e6, seconds);
  if (taken) into = std::chrono::duration<double>(seconds);
  return taken;
}

bool* flag_of(Options& options, std::string_view name) {
  if (name == "--quiet") return &options.quiet;
  if (name == "--stop-when-posted") return &options.stop_when_posted;
  if (name == "--generate-only") return &options.generate_only;
  if (name == "--help" || name == "-h") return &options.help;
  return nullptr;
}

std::optional<Taken> take(Options& options, std::string_view name, std::string_view value) {
  constexpr std::uint64_t kMostRobots = 30;
  if (name == "--post") return take_url(value, options.post);
  if (name == "--scoring") return take_url(value, options.scoring);
  if (name == "--secrets") return take_path(value, options.secrets);
  if (name == "--robots") return take_whole(value, kMostRobots, options.robots);
  if (name == "--style") return take_style(value, options.style);
  if (name == "--maps") return take_path(value, options.maps);
  if (name == "--for") return take_seconds(value, options.run_for);
  if (name == "--seed") return take_whole(value, UINT64_MAX, options.seed);
  if (name == "--truth") return take_path(value, options.truth);
  if (name == "--speed") return take_number(value, 0.1, 20, options.speed);
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

std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string name = arguments[i];
    if (bool* const flag = flag_of(options, name)) {
      *flag = true;
      continue;
    }
    const bool last = i + 1 == arguments.size();
    const auto taken = take(options, name, last ? "" : arguments[i + 1]);
    if (!taken) return std::unexpected(name + ": no such option");
    if (last) return std::unexpected(name + ": needs a value");
    if (!*taken) return std::unexpected(name + ": " + taken->error());
    ++i;
  }
  return complete(std::move(options));
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
