#pragma once

#include <chrono>
#include <expected>
#include <string>

#include "admin/factory_reset.hpp"
#include "admin/store.hpp"
#include "admin/takeover.hpp"
#include "gateway/file_return.hpp"
#include "gateway/gateway.hpp"
#include "gateway/listeners.hpp"
#include "gateway/options.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::gateway {

/// aditd's process: a gateway that runs until a stop, or until a restart by exec after a factory reset or
/// when unreadable files return. Each start reads the disk.
class Service {
 public:
  /// `options` and `arguments`, main()'s, outlive this.
  Service(const Options& options, char* const* arguments);

  /// After this many faults, each within kWell of a start, queued messages are put aside as a possible cause.
  static constexpr std::uintmax_t kMostFaults = 3;
  static constexpr std::chrono::seconds kWell{60};

  /// Returns 0 after SIGTERM or SIGINT, 1 if it could not start, with a log entry. Otherwise it ends in exec.
  /// `count_faults`: loop::count_faults(), with the file's name.
  int run(int (*count_faults)(const char* file) noexcept);

 private:
  std::expected<bool, std::string> run_gateway();
  std::expected<bool, std::string> run(Gateway& gateway, const settings::Settings& settings);
  std::expected<void, std::string> take_over_sockets();
  std::string finish_takeover();
  /// One byte per fault.
  std::string faults_file() const;
  std::string put_queue_aside();
  void forget_faults();
  [[noreturn]] void restart_process(const std::string& trouble);

  const Options& options_;
  char* const* const arguments_;
  admin::Store store_;
  admin::FactoryReset reset_;
  admin::Takeover takeover_;
  ListenSockets sockets_;
  loop::Loop loop_;
  loop::FileDescriptor announced_;  // to adit-panel, until the lights are opened
  Gateway* running_ = nullptr;      // valid while the loop runs
  std::string trouble_;             // about the last change
  std::chrono::seconds file_rest_;  // for unreadable files
};

}  // namespace adit::gateway
