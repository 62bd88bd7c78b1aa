#pragma once

#include <expected>
#include <string>

#include "applier/sticks.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"
#include "spare/stick.hpp"

namespace adit::applier {

/// adit-spare at work: carries exports to the stick and from it, as aditd asks, one after the other, and
/// tells how it stands.
class SpareKeeper {
 public:
  /// Outlives this.
  explicit SpareKeeper(const SpareOptions& options)
      : options_(options), sticks_(options), file_(options.status + '/' + host::kStatusFile) {}

  /// Until nothing is asked for. An error: its own folder is not as it should be, or what is asked for cannot
  /// be taken away. What was asked before the machine was restarted is dropped: whoever asked has seen that
  /// it came to nothing.
  std::expected<void, std::string> work();

 private:
  void answer(const spare::StickRequest& request, host::UntrustedFolder& folder);
  /// "", or why it is not done.
  std::string write(const std::string& name, const std::expected<std::string, std::string>& bytes);
  std::string write_to(const spare::Medium& medium, const std::string& name, const std::string& bytes);
  std::string check(const spare::Medium& medium, const std::string& name, const std::string& bytes);
  std::string take(const std::string& name);
  void doing(const char* what);
  void look();
  bool tell();

  const SpareOptions& options_;
  Sticks sticks_;
  spare::StickStatus status_;
  host::StatusFile file_;
};

}  // namespace adit::applier
