#include "simulation/options.hpp"

#include <random>

#include "command_line/program.hpp"

namespace adit::simulation {
namespace {

command_line::Wrong omit(Omissions& without, const std::string& words) {
  without = Omissions(words);
  return std::nullopt;
}

}  // namespace

command_line::Program command_line_of(Options& options) {
  using command_line::number;
  options.seed = std::random_device{}();
  return {
      .name = "adit_simulation",
      .about = "Plays the whole gateway in a simulated world.",
      .rows =
          {{"--seed", "N", "the first seed; a fresh one without it", number<0UL, UINT64_MAX>(options.seed)},
           {"--runs", "N", "so many runs; 1, or until the time is up", number<1UL, UINT64_MAX>(options.runs)},
           {"--hours", "H", "no run begins after so much time", number<0.0, 1e6>(options.hours)},
           {"--cpu", "SECONDS", "no run begins after so much CPU of one job", number<0.0, 1e9>(options.cpu)},
           {"--jobs", "N", "so many processes, each with seeds of its own",
            number<1UL, UINT64_MAX>(options.jobs)},
           {"--without", "WORDS", "what is left out of the runs, as a shrunk run's replay says",
            command_line::set_by<omit>(options.without)},
           {"--log", "", "each event", &options.log},
           {"--story", "", "each event without what is of every run", &options.story},
           {"--until", "CHECK", "ends where that check finds something", &options.until},
           {"--as-it-is", "", "a run that fails is not shrunk", &options.as_it_is}},
      .ending = "Exits 0 where all runs were good, 1 where one was not, 2 on a wrong command line.",
      .empty = command_line::EmptyValue::Accepted,
  };
}

std::expected<Options, std::string> read_options(std::span<const char* const> arguments) {
  auto options = command_line::read(command_line_of, arguments);
  if (options && options->runs == 0) options->runs = options->hours > 0 || options->cpu > 0 ? UINT64_MAX : 1;
  return options;
}

}  // namespace adit::simulation
