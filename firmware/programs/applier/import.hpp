#pragma once

#include <expected>
#include <string>

#include "applier/card.hpp"
#include "applier/options.hpp"
#include "host/untrusted_folder.hpp"

namespace adit::applier {

/// Imports the files on the boot partition into the box's state, all or none, and writes the result to
/// taken.txt.
///
/// Tokens are wiped and other files renamed only after the state is stored, so a power cut repeats or
/// finishes the import. If the state is in memory, the files stay and every start imports them. Run while
/// neither aditd nor adit-network runs.
class Import {
 public:
  /// `options` must outlive this object.
  explicit Import(const ImportOptions& options) : options_(options) {}

  /// Error: correct files could not be imported. Faults in the files are reported on the card and in the
  /// journal, and are not an error.
  std::expected<void, std::string> run();

 private:
  std::expected<settings::Settings, std::string> in_force() const;
  std::expected<void, std::string> save(const CardContents& brought);
  std::expected<void, std::string> save_tokens(host::UntrustedFolder& state, const CardContents& brought);
  std::expected<void, std::string> save_settings(host::UntrustedFolder& state,
                                                 const settings::Settings& settings);

  const ImportOptions& options_;
};

}  // namespace adit::applier
