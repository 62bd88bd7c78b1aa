#include "applier/options.hpp"

#include <string_view>
#include <utility>

namespace adit::applier {
namespace {

/// The kernel's dev_valid_name(), and nothing that means more to systemd.network(5): a pattern, a list, a
/// negation.
bool is_interface(std::string_view name) {
  return !name.empty() && name.size() <= 15 && name != "." && name != ".." &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
             std::string_view::npos;
}

}  // namespace

command_line::Program command_line_of(Options& options) {
  return {
      .name = "adit-network",
      .usage = "",
      .about =
          "Changes the addresses of Adit's two network interfaces, as aditd asks, by systemd-networkd; and "
          "takes a change back by itself unless it is confirmed in time. Ends once nothing is left to do.",
      .rows = {{"--team", "NAME", "the interface to the team", &options.team},
               {"--command-post", "NAME", "the interface to the Command Post", &options.command_post},
               {"--wanted", "DIR", "where aditd asks", &options.wanted},
               {"--status", "DIR", "where it is answered", &options.status},
               {"--state", "DIR", "where what was confirmed is kept", &options.state},
               {"--factory", "FILE", "the addresses where none were confirmed", &options.factory},
               {"--networkd", "DIR", "networkd's folder until the next start", &options.networkd},
               {"--networkctl", "CMD", "what makes networkd read them, called with the word reload",
                &options.networkctl},
               {"--start", "", "only writes networkd's files: before networkd starts", &options.start},
               {"--watch", "",
                "only tells, in the folder of --status, which other machine uses the box's addresses",
                &options.watch},
               {"--told", "DIR", "where --watch reads what adit-network tells of the endpoints",
                &options.told},
               {"--version", "", "prints the version", &options.version},
               {"--help", "", "prints this", &options.help}},
      .ending =
          "Exits 0 once nothing is pending, 1 where it cannot do its work, networkd has not read its files, "
          "or what is asked for cannot be taken away or done (and says why), 2 on a wrong command line.",
  };
}

std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  const auto options = command_line::read(command_line_of, arguments);
  if (!options) return options;
  for (const auto& [word, name] :
       {std::pair("--team", options->team), std::pair("--command-post", options->command_post)}) {
    if (!is_interface(name)) return std::unexpected(std::string(word) + " wants an interface's name");
  }
  if (options->team == options->command_post)
    return std::unexpected("--team and --command-post name the same interface");
  if (options->start && options->watch)
    return std::unexpected("--start and --watch are two different things");
  return options;
}

}  // namespace adit::applier
