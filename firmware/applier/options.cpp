#include "applier/options.hpp"

#include <string_view>
#include <utility>

#include "host/command_line.hpp"

namespace adit::applier {
namespace {

constexpr host::Flag<Options> kFlags[] = {
    {"--start", &Options::start}, {"--help", &Options::help}, {"--version", &Options::version}};
constexpr host::Value<Options> kValues[] = {
    {"--wanted", &Options::wanted},   {"--status", &Options::status},
    {"--state", &Options::state},     {"--networkd", &Options::networkd},
    {"--factory", &Options::factory}, {"--networkctl", &Options::networkctl},
    {"--team", &Options::team},       {"--command-post", &Options::command_post}};

/// The kernel's dev_valid_name(), and nothing that means more to systemd.network(5): a pattern, a list, a
/// negation.
bool is_interface(std::string_view name) {
  return !name.empty() && name.size() <= 15 && name != "." && name != ".." &&
         name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
             std::string_view::npos;
}

}  // namespace

const char* const kUsage =
    "Usage: adit-network [OPTION VALUE]...\n"
    "\n"
    "Changes the addresses of Adit's two network interfaces, as aditd asks, by systemd-networkd; and takes "
    "a\n"
    "change back by itself unless it is confirmed in time. Ends once nothing is left to do.\n"
    "\n"
    "  --team NAME          the interface to the team (team0)\n"
    "  --command-post NAME  the interface to the Command Post (darpa0)\n"
    "  --wanted DIR         where aditd asks (/var/lib/private/adit)\n"
    "  --status DIR         where it is answered (/run/adit-network)\n"
    "  --state DIR          where what was confirmed is kept (/var/lib/adit-network)\n"
    "  --factory FILE       the addresses where none were confirmed (/usr/share/adit/network.json)\n"
    "  --networkd DIR       networkd's folder until the next start (/run/systemd/network)\n"
    "  --networkctl CMD     what makes networkd read them, called with the word reload (networkctl)\n"
    "  --start              only writes networkd's files: before networkd starts\n"
    "  --version            prints the version\n"
    "  --help               prints this\n"
    "\n"
    "Exits 0 once nothing is pending, 1 where it cannot do its work, or what is asked for cannot be taken "
    "away (and\n"
    "says why), 2 on a wrong command line.\n";

std::expected<Options, std::string> parse_options(std::span<char* const> arguments) {
  const auto options = host::read_command_line<Options>(arguments, kFlags, kValues);
  if (!options) return options;
  for (const auto& [word, name] :
       {std::pair("--team", options->team), std::pair("--command-post", options->command_post)}) {
    if (!is_interface(name)) return std::unexpected(std::string(word) + " wants an interface's name");
  }
  if (options->team == options->command_post)
    return std::unexpected("--team and --command-post name the same interface");
  return options;
}

}  // namespace adit::applier
