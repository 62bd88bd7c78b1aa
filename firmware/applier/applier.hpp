#pragma once

#include <optional>
#include <string>

#include "applier/networkd_files.hpp"
#include "applier/options.hpp"
#include "host/root_program.hpp"
#include "host/untrusted_folder.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "network/change.hpp"

namespace adit::applier {

/// adit-network at work: takes what aditd asks for, does it, tells how it stands, and ends the loop once
/// nothing is pending.
class Applier {
 public:
  /// Both outlive this.
  Applier(loop::Loop& loop, const Options& options);

  /// An error: its own folders are not as they should be. Requests of an earlier start of the machine are
  /// dropped: whoever asked has seen that it came to nothing.
  std::expected<void, std::string> start();
  /// A pending change is reverted, and the loop ends.
  void stop();

  /// Nothing is left to be tried again by another start, but not at once: a request that could not be taken
  /// away or be done, or what networkd has not read.
  bool is_done() const { return !is_stuck_ && !files_.reload_is_due(); }

 private:
  void look();
  void drop_requests();
  void take_requests();
  void take_wanted();
  void take_word();
  void take_probe();
  void take_endpoints();
  bool take_forget();
  bool forget(const std::string& text);
  void after();
  bool tell();
  void answer_probe(const network::Probe& probe);
  std::string side_of(std::uint32_t address) const;
  /// What is asked for in the file of that name, which is taken away; nothing: nothing that can be done.
  template <class Request>
  std::optional<Request> asked(const char* name);
  void remove(const char* name);
  void cannot_take(const std::string& why);
  void watch_folder();

  loop::Loop& loop_;
  const Options& options_;
  NetworkdFiles files_;
  host::StatusFile file_;
  std::optional<network::Change> change_;
  std::optional<host::UntrustedFolder> folder_;
  loop::FileDescriptor notices_;
  loop::Source noticed_, due_;
  bool is_stuck_ = false;
};

}  // namespace adit::applier
