/// adit-import: takes what a card reader put on the boot partition, as root, before aditd starts.

#include "applier/import.hpp"
#include "host/command_line.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit::applier;
  const auto options =
      parse_import_options(std::span<char* const>(argv + 1, static_cast<std::size_t>(argc - 1)));
  if (const auto exit = adit::host::answered("adit-import", ADIT_VERSION, kImportUsage, options))
    return *exit;
  if (const auto done = Import(*options).run(); !done) {
    adit::host::log(adit::host::Level::Error, "cannot take what was brought", {{"why", done.error()}});
    return 1;
  }
  return 0;
}
