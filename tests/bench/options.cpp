#include "options.hpp"

#include <charconv>
#include <string_view>

#include "command_line/number.hpp"

namespace adit::bench {
namespace {

template <class Number>
std::optional<Number> whole(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number == 0) return std::nullopt;
  return number;
}

std::optional<Way> way(std::string_view word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos || equals == 0) return std::nullopt;
  const std::string_view where = word.substr(equals + 1);
  const std::size_t colon = std::min(where.find(':'), where.size());
  const auto port = whole<std::uint16_t>(where.substr(0, colon));
  if (!port) return std::nullopt;
  const auto process = whole<pid_t>(where.substr(std::min(colon + 1, where.size())));
  return Way{.name = std::string(word.substr(0, equals)), .port = *port, .process = process.value_or(0)};
}

command_line::Wrong take_what(Kind& what, const std::string& word) {
  if (word != "reports" && word != "states") return "'" + word + "': expected reports or states";
  what = word == "states" ? Kind::States : Kind::Reports;
  return std::nullopt;
}

command_line::Wrong take_way(std::vector<Way>& ways, const std::string& word) {
  auto made = way(word);
  if (!made) return "'" + word + "' is no way: expected NAME=PORT or NAME=PORT:PID";
  ways.push_back(*std::move(made));
  return std::nullopt;
}

}  // namespace

command_line::Program command_line_of(Options& options) {
  using command_line::number;
  using command_line::Wanted;
  return {
      .name = "adit_bench_load",
      .usage = "direct=PORT NAME=PORT:PID...",
      .about = "Sends messages to the Command Post by several ways, in turns, and compares what they take.",
      .rows = {{"--flush", "FOLDER", "the ledger's", &options.flush, Wanted::Always},
               {"--token", "TOKEN", "of the team and of scoring", &options.token, Wanted::Always},
               {"--what", "KIND", "reports or states (reports)", command_line::take<take_what>(options.what)},
               {"--messages", "N", "on each way (2000)", number<1, 1'000'000>(options.messages)},
               {"--seconds", "S", "at most (600)", number<1, 1'000'000>(options.most)},
               {"--pace", "MS", "from the start of one to that of the next (5)",
                number<1, 1'000'000>(options.pace)},
               {"--block", "N", "messages on one way before the next has its turn (20)",
                number<1, 1'000'000>(options.block)},
               {"--help", "", "prints this", &options.help}},
      .ending = "",
      .word = command_line::take<take_way>(options.ways),
  };
}

std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  auto options = command_line::read(command_line_of, arguments);
  if (options && !options->help && options->ways.size() < 2) return std::unexpected("two ways are needed");
  return options;
}

}  // namespace adit::bench
