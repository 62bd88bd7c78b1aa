#include "panel/lights_options.hpp"

#include <charconv>
#include <string_view>

namespace adit::panel {

const char* const kLightsUsage =
    "Usage: adit-lights fault|dark|ended [--board FILE] [--settings FILE]... [--simulated FILE] [--seconds "
    "N]\n"
    "\n"
    "Sets the lights of the panel while aditd does not run.\n"
    "\n"
    "  fault             shows that Adit has died, until it is ended or N seconds are over; then dark\n"
    "  dark              makes all lights dark\n"
    "  ended             for ExecStopPost=: the one or the other, by $SERVICE_RESULT\n"
    "\n"
    "  --board FILE      what the board is (board.json); where it names a panel, that counts\n"
    "  --settings FILE   aditd's settings; of several the first that can be read counts\n"
    "  --simulated FILE  where the lights are shown if neither names a line\n"
    "  --seconds N       1 to 3600\n"
    "  --version         prints the version\n"
    "  --help            prints this\n"
    "\n"
    "Exits 0, 1 where the lines cannot be had or are not known (and says why), 2 on a wrong command line.\n";

namespace {

using Word = LightsOptions::Word;

std::optional<Word> word_of(std::string_view text) {
  if (text == "fault") return Word::Fault;
  if (text == "dark") return Word::Dark;
  if (text == "ended") return Word::Ended;
  return std::nullopt;
}

std::optional<std::chrono::seconds> seconds_of(std::string_view text) {
  constexpr int kMost = 3600;
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number < 1 || number > kMost) {
    return std::nullopt;
  }
  return std::chrono::seconds(number);
}

/// Requires an option's name.
std::expected<void, std::string> put(LightsOptions& options, std::string_view name, const char* value) {
  if (name == "--board") options.board = value;
  if (name == "--settings") options.settings.emplace_back(value);
  if (name == "--simulated") options.simulated = value;
  if (name != "--seconds") return {};
  options.seconds = seconds_of(value);
  if (options.seconds) return {};
  return std::unexpected("--seconds: expected 1 to 3600, got '" + std::string(value) + "'");
}

bool is_option(std::string_view text) {
  return text == "--board" || text == "--settings" || text == "--simulated" || text == "--seconds";
}

}  // namespace

std::expected<LightsOptions, std::string> parse_lights_options(std::span<char* const> arguments) {
  LightsOptions options;
  std::optional<Word> word;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view text = arguments[i];
    if (text == "--help" || text == "--version") {
      (text == "--help" ? options.help : options.version) = true;
    } else if (is_option(text)) {
      if (++i == arguments.size()) return std::unexpected(std::string(text) + " wants a value");
      if (const auto done = put(options, text, arguments[i]); !done) return std::unexpected(done.error());
    } else if (!word && word_of(text)) {
      word = word_of(text);
    } else {
      return std::unexpected("unknown word '" + std::string(text) + "'");
    }
  }
  if (!word && !options.help && !options.version) return std::unexpected("fault, dark or ended is missing");
  options.word = word.value_or(Word::Dark);
  return options;
}

bool has_died(const char* service_result) {
  return service_result != nullptr && std::string_view(service_result) != "success";
}

}  // namespace adit::panel
