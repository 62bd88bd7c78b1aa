#pragma once

#include <optional>
#include <string>

#include "applier/bundle_file.hpp"
#include "applier/rauc.hpp"
#include "applier/update_options.hpp"
#include "host/root_program.hpp"
#include "update/messages.hpp"

namespace adit::applier {

/// adit-update at work: does what aditd asks for, one thing after the other, and tells how it stands.
class Updater {
 public:
  /// Outlives this.
  explicit Updater(const UpdateOptions& options)
      : options_(options), rauc_(options.rauc), file_(options.status + '/' + host::kStatusFile) {}

  /// Until nothing is asked for. An error: its own folders are not as they should be, or what is asked for
  /// cannot be taken away. What was asked before the machine was restarted is dropped: whoever asked has
  /// seen that it came to nothing.
  std::expected<void, std::string> work();

 private:
  void find_out();
  void look_at_sticks();
  void answer(const update::Request& request, host::UntrustedFolder& folder);
  /// "", or why it is not done.
  std::string install(const std::expected<BundleFile, std::string>& file, bool again);
  std::string give_up_other();
  std::string write(const BundleFile& file, const update::Bundle& bundle);
  std::string restart();
  std::string go_back();
  std::string stay();
  void tell_of(update::LastUpdate last_update);
  bool tell();

  const UpdateOptions& options_;
  Rauc rauc_;
  std::string boot_;
  update::Status status_;
  std::string on_stick_;  // the file of status_.stick
  host::StatusFile file_;
};

}  // namespace adit::applier
