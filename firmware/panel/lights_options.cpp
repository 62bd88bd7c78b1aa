#include "panel/lights_options.hpp"

#include <string_view>

#include "command_line/number.hpp"

namespace adit::panel {
namespace {

using Word = LightsOptions::Word;

template <Word Which>
command_line::Take one(std::optional<Word>& into) {
  return command_line::take<[](std::optional<Word>& word, const std::string&) -> command_line::Wrong {
    if (word) return "fault, dark and ended are three things: which one?";
    word = Which;
    return std::nullopt;
  }>(into);
}

}  // namespace

command_line::Program lights_command_line_of(LightsOptions& options) {
  return {
      .name = "adit-lights",
      .usage = "fault|dark|ended",
      .about = "Sets the lights of the panel while aditd does not run.",
      .rows = {{"fault", "", "shows that Adit has died, until it is ended or N seconds are over; then dark",
                one<Word::Fault>(options.word)},
               {"dark", "", "makes all lights dark", one<Word::Dark>(options.word)},
               {"ended", "", "for ExecStopPost=: the one or the other, by $SERVICE_RESULT",
                one<Word::Ended>(options.word)},
               {"--board", "FILE", "what the board is (board.json); where it names a panel, that counts",
                &options.board},
               {"--settings", "FILE", "aditd's settings; of several the first that can be read counts",
                &options.settings},
               {"--simulated", "FILE", "where the lights are shown if neither names a line",
                &options.simulated},
               {"--seconds", "N", "1 to 3600", command_line::number<1, 3600>(options.seconds)},
               {"--version", "", "prints the version", &options.version},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Exits 0, 1 where the lines cannot be had or are not known (and says why), 2 on a wrong command "
          "line.",
      .empty = command_line::Empty::Taken,
  };
}

std::expected<LightsOptions, std::string> parse_lights_options(std::span<const char* const> arguments) {
  auto options = command_line::read(lights_command_line_of, arguments);
  if (options && !options->word && !options->help && !options->version)
    return std::unexpected("fault, dark or ended is missing");
  return options;
}

bool has_died(const char* service_result) {
  return service_result != nullptr && std::string_view(service_result) != "success";
}

}  // namespace adit::panel
