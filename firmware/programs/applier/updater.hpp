#pragma once

#include <string>

#include "applier/bundle_file.hpp"
#include "applier/options.hpp"
#include "applier/rauc.hpp"
#include "host/root_program.hpp"
#include "update/messages.hpp"

namespace adit::applier {

/// The work of adit-update: executes aditd's requests one after the other and reports the status.
class Updater {
 public:
  /// `options` must outlive this object.
  explicit Updater(const UpdateOptions& options)
      : options_(options), rauc_(options.rauc), file_(options.status + '/' + host::kStatusFile) {}

  /// Answers all requests, then returns. Error: its own directories are unusable, or a request cannot be
  /// removed. Requests from before the boot are dropped, because their senders have seen them fail.
  std::expected<void, std::string> work();

 private:
  void find_out();
  void look_at_sticks();
  void answer(const update::Request& request, host::UntrustedFolder& folder);
  /// "", or why it failed.
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
  std::string on_stick_;  // path of status_.stick
  host::StatusFile file_;
};

}  // namespace adit::applier
