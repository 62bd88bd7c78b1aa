#pragma once

#include <expected>
#include <string>

#include "applier/card.hpp"
#include "command_line/program.hpp"
#include "host/untrusted_folder.hpp"

namespace adit::applier {

/// adit-import's command line.
struct ImportOptions {
  std::string card = "/boot/adit";                    // what was put there
  std::string state = "/var/lib/private/adit";        // aditd's
  std::string network = "/var/lib/adit-network";      // adit-network's
  std::string given = "/etc/adit/settings.json";      // the settings of the image
  std::string in_memory = "/run/adit-notices/state";  // is there where the state is lost at the next start
  bool help = false, version = false;
};

[[gnu::cold]] command_line::Program import_command_line_of(ImportOptions& options);

/// Takes what was put on the boot partition into the box's state, all of it or nothing, and leaves there
/// what became of it, in taken.txt.
///
/// Tokens are wiped from the card and other files renamed only once all is in the state: a power cut before
/// that finds the same files again, and one after it finds fewer. Where the state is in memory alone they
/// stay on the card, and are taken at each start. Runs while neither aditd nor adit-network does.
class Import {
 public:
  /// `options` outlives this.
  explicit Import(const ImportOptions& options) : options_(options) {}

  /// An error: what is right could not be taken. What is wrong with the files is told on the card and in the
  /// journal, and is none.
  std::expected<void, std::string> run();

 private:
  settings::Settings in_force() const;
  std::expected<void, std::string> save(const Brought& brought);
  std::expected<void, std::string> save_tokens(host::UntrustedFolder& state, const Brought& brought);
  std::expected<void, std::string> save_settings(host::UntrustedFolder& state,
                                                 const settings::Settings& settings);

  const ImportOptions& options_;
};

}  // namespace adit::applier
