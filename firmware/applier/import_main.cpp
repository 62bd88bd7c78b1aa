/// adit-import: imports a user's files from the boot partition, as root, before aditd starts.

#include "applier/import.hpp"
#include "command_line/answer.hpp"
#include "host/log.hpp"

int main(int argc, char** argv) {
  using namespace adit::applier;
  const auto options = adit::command_line::read(import_command_line_of, {argv + 1, argv + argc});
  if (const auto exit = adit::command_line::answer(import_command_line_of, ADIT_VERSION, options))
    return *exit;
  if (const auto done = Import(*options).run(); !done) {
    adit::host::log(adit::host::Level::Error, "cannot accept the card's files", {{"why", done.error()}});
    return 1;
  }
  return 0;
}
