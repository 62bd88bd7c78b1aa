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

/// adit-network's work: executes aditd's requests, writes the status, and ends once no change is pending.
class Applier {
 public:
  /// Both must outlive this object.
  Applier(loop::Loop& loop, const Options& options);

  /// Error: its own directories are unusable. Requests from before the boot are dropped, because their
  /// senders have seen them fail.
  std::expected<void, std::string> start();
  /// Reverts a pending change and stops the loop.
  void stop();

  /// False if a later start must retry: a request could not be removed or executed, or networkd has not read
  /// its files. The retry must not come at once.
  bool is_done() const { return !is_stuck_ && !files_.reload_is_due(); }

 private:
  void poll();
  void drop_requests();
  void handle_requests();
  void handle_wanted();
  void handle_word();
  void handle_probe();
  void handle_endpoints();
  bool handle_forget();
  bool forget(const std::string& text);
  void run_after_requests();
  bool write_status();
  void answer_probe(const network::Probe& probe);
  void find_address(std::uint32_t address, network::ProbeResult& probed) const;
  /// Reads and removes the request in a file. std::nullopt: no valid request.
  template <class Request>
  std::optional<Request> read_request(const char* name);
  void remove(const char* name);
  void on_stuck_request(const std::string& why);
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
