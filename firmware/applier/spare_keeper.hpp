#pragma once

#include <expected>
#include <string>

#include "applier/sticks.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"
#include "spare/stick.hpp"

namespace adit::applier {

/// The work of adit-spare: copies exports to and from the stick, one after the other, on aditd's request, and
/// reports the status.
class SpareKeeper {
 public:
  /// `options` must outlive this object.
  explicit SpareKeeper(const SpareOptions& options)
      : options_(options), sticks_(options), file_(options.status + '/' + host::kStatusFile) {}

  /// Answers all requests, then returns. Error: its own directory is unusable, or a request cannot be
  /// removed. Requests from before the boot are dropped, because their senders have seen them fail.
  std::expected<void, std::string> work();

 private:
  void answer(const spare::StickRequest& request, host::UntrustedFolder& folder);
  /// "", or why it failed.
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
