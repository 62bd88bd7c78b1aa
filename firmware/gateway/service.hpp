#pragma once

#include <chrono>
#include <expected>
#include <string>

#include "admin/factory_reset.hpp"
#include "admin/store.hpp"
#include "admin/taking_over.hpp"
#include "gateway/file_return.hpp"
#include "gateway/gateway.hpp"
#include "gateway/listen_sockets.hpp"
#include "gateway/options.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::gateway {

/// The life of aditd: a gateway that runs until it is stopped, or until the process starts again by exec,
/// after a factory reset or if a file can be read again that could not be. Each start reads the disk.
class Service {
 public:
  /// `options` and `arguments`, main()'s, outlive this.
  Service(const Options& options, char* const* arguments);

  /// After so many ends by a fault of its own, each less than kWell after its start, a start puts aside what
  /// is queued: it may be the reason.
  static constexpr std::uintmax_t kMostFaults = 3;
  static constexpr std::chrono::seconds kWell{60};

  /// Until SIGTERM or SIGINT: 0; 1: it could not start, and has said why. Else it ends in exec.
  /// `count_faults`: loop::count_faults(); it gets the name of the file.
  int run(void (*count_faults)(const char* file) noexcept);

 private:
  std::expected<bool, std::string> run_gateway();
  std::expected<bool, std::string> run(Gateway& gateway, const settings::Settings& settings);
  std::expected<void, std::string> take_over_sockets();
  std::string finish_taking_over();
  /// Has a byte for each fault.
  std::string faults_file() const;
  std::string put_queue_aside();
  [[noreturn]] void start_again(const std::string& trouble);

  const Options& options_;
  char* const* const arguments_;
  admin::Store store_;
  admin::FactoryReset reset_;
  admin::TakingOver taking_over_;
  ListenSockets sockets_;
  loop::Loop loop_;
  loop::FileDescriptor announced_;  // to adit-panel, until its lights are opened
  Gateway* running_ = nullptr;      // signals come while the loop runs, and so does it
  std::string trouble_;             // a sentence about the last change
  std::chrono::seconds file_rest_;  // if a file cannot be read; then that of the next start
};

}  // namespace adit::gateway
