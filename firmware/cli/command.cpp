#include "cli/command.hpp"

#include "cli/ask.hpp"
#include "cli/commands.hpp"
#include "cli/help.hpp"
#include "host/log.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

Result<Outcome> outcome_of(const Options& options, const Console& console) {
  const Run& run = options.form->run;
  if (run.alone != nullptr) return run.alone(options, console);
  const auto adit = ADIT_TRY(adit_of(options));
  return run.asks({adit, options, console});
}

}  // namespace

Outcome run(const Options& options, const Console& console) {
  const auto outcome = outcome_of(options, console);
  return outcome ? *outcome : unable(outcome.error());
}

Outcome run(std::span<const std::string_view> words, const Console& console) {
  const auto options = parse_options(words);
  if (!options) {
    const auto& [sentence, command] = options.error();
    return {Exit::Unable, "", "adit: " + host::escaped(sentence) + '\n' + see_help(command)};
  }
  if (options->version) return {Exit::Fine, "adit " ADIT_VERSION "\n", ""};
  if (options->help) return {Exit::Fine, help_about(options->command), ""};
  return run(*options, console);
}

}  // namespace adit::cli
