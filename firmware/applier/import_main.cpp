/// adit-import: takes what a card reader put on the boot partition, as root, before aditd starts.

#include <cstdio>

#include "applier/import.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit::applier;
  const auto options =
      parse_import_options(std::span<char* const>(argv + 1, static_cast<std::size_t>(argc - 1)));
  if (!options) {
    std::fprintf(stderr, "adit-import: %s\n%s", options.error().c_str(), kImportUsage);
    return 2;
  }
  if (options->help) return std::fputs(kImportUsage, stdout) < 0 ? 1 : 0;
  if (options->version) return std::printf("adit-import %s\n", ADIT_VERSION) < 0 ? 1 : 0;
  if (const auto done = Import(*options).run(); !done) {
    adit::host::log(adit::host::Level::Error, "cannot take what was brought", {{"why", done.error()}});
    return 1;
  }
  return 0;
}
