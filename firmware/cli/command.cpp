#include "cli/command.hpp"

#include "cli/actions.hpp"
#include "cli/ask.hpp"
#include "cli/check.hpp"
#include "cli/clock.hpp"
#include "cli/complete.hpp"
#include "cli/help.hpp"
#include "cli/ledger.hpp"
#include "cli/network.hpp"
#include "cli/options.hpp"
#include "cli/rejected.hpp"
#include "cli/reports.hpp"
#include "cli/runs.hpp"
#include "cli/settings.hpp"
#include "cli/spare.hpp"
#include "cli/test.hpp"
#include "cli/update.hpp"
#include "cli/watch.hpp"
#include "host/log.hpp"

namespace adit::cli {

Outcome run(std::span<const std::string_view> words, const Console& console) {
  const auto options = parse_options(words);
  if (!options)
    return {Exit::Unable, "",
            "adit: " + host::escaped(options.error().sentence) + '\n' + see_help(options.error().command)};
  if (options->version) return {Exit::Fine, "adit " ADIT_VERSION "\n", ""};
  const bool colour = console.colour;
  switch (options->command) {
    case Command::Status:
      return status(*options, colour);
    case Command::Watch:
      return watch(*options, console);
    case Command::Reports:
      return reports(*options, console);
    case Command::Rejected:
      return rejected(*options, colour);
    case Command::Run:
      return options->verb == Verb::New ? begin_run(*options) : present_run(*options, colour);
    case Command::Runs:
      return runs(*options, console);
    case Command::Settings:
      return settings(*options, colour);
    case Command::Course:
      return course(*options, colour);
    case Command::Identify:
      return identify(*options);
    case Command::Clock:
      return clock(*options);
    case Command::Spare:
      return spare(*options, console);
    case Command::Ledger:
      return ledger(*options, console);
    case Command::Network:
      return network(*options);
    case Command::Test:
      return test(*options, colour, console.print);
    case Command::Update:
      return update(*options, console.print);
    case Command::Check:
      return check(*options, colour);
    case Command::Complete:
      return complete(*options);
    case Command::Help:
      break;
  }
  return {Exit::Fine, help_about(options->about), ""};
}

}  // namespace adit::cli
