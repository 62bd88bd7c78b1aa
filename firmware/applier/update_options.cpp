#include "applier/update_options.hpp"

#include <charconv>
#include <optional>
#include <string_view>

#include "host/command_line.hpp"

namespace adit::applier {
namespace {

/// As they are written; a member whose kind is not a text stands here as one.
struct Written : UpdateOptions {
  std::string within_seconds = "";
};
constexpr host::Flag<Written> kFlags[] = {
    {"good", &Written::good}, {"--help", &Written::help}, {"--version", &Written::version}};
constexpr host::Value<Written> kValues[] = {{"--wanted", &Written::wanted},
                                            {"--status", &Written::status},
                                            {"--state", &Written::state},
                                            {"--sticks", &Written::sticks},
                                            {"--os-release", &Written::os_release},
                                            {"--hindrance", &Written::hindrance},
                                            {"--rauc", &Written::rauc},
                                            {"--systemctl", &Written::systemctl},
                                            {"--within", &Written::within_seconds}};

std::optional<std::chrono::seconds> seconds_in(std::string_view text) {
  int seconds = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), seconds);
  if (error != std::errc{} || end != text.data() + text.size() || seconds < 1 || seconds > 3600)
    return std::nullopt;
  return std::chrono::seconds(seconds);
}

}  // namespace

const char* const kUpdateUsage =
    "Usage: adit-update [good] [OPTION VALUE]...\n"
    "\n"
    "Updates the box, by RAUC, as aditd asks: checks a bundle, installs it into the slot that does not run,\n"
    "and starts the machine anew. Ends once nothing is asked for.\n"
    "\n"
    "  good              watches a start of the machine instead: marks the slot good once aditd is healthy, "
    "or\n"
    "                    starts the machine anew where a slot on trial does not become so\n"
    "  --within SECONDS  how long a slot on trial may take for that (300)\n"
    "  --wanted DIR      where aditd asks (/var/lib/private/adit)\n"
    "  --status DIR      where it is answered (/run/adit-update)\n"
    "  --state DIR       where what became of the last update is kept (/var/lib/adit-update)\n"
    "  --sticks DIR      in whose folders USB sticks are mounted (/run/adit-stick)\n"
    "  --os-release FILE says by VERSION_ID which version runs (/etc/os-release)\n"
    "  --hindrance FILE  says, where it is there, why none may be installed (/run/adit-notices/disks)\n"
    "  --rauc CMD        RAUC (rauc)\n"
    "  --systemctl CMD   systemd (systemctl)\n"
    "  --version         prints the version\n"
    "  --help            prints this\n"
    "\n"
    "Exits 0 once it is done, 1 where it cannot do its work (and says why), 2 on a wrong command line.\n";

std::expected<UpdateOptions, std::string> parse_update_options(std::span<char* const> arguments) {
  auto written = host::read_command_line<Written>(arguments, kFlags, kValues);
  if (!written) return std::unexpected(written.error());
  if (!written->within_seconds.empty()) {
    const auto seconds = seconds_in(written->within_seconds);
    if (!seconds) return std::unexpected("--within wants 1 to 3600 seconds");
    written->within = *seconds;
  }
  return std::move(*written);
}

}  // namespace adit::applier
