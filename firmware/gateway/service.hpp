#pragma once

#include <chrono>
#include <expected>
#include <optional>
#include <string>

#include "admin/factory_reset.hpp"
#include "admin/store.hpp"
#include "admin/taking_over.hpp"
#include "gateway/gateway.hpp"
#include "gateway/ledger_return.hpp"
#include "gateway/listen_sockets.hpp"
#include "gateway/options.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "loop/watchdog.hpp"

namespace adit::gateway {

/// The life of aditd. Gateways, one after the other on one loop: each runs until it is stopped, or makes way
/// for another: after a factory reset, or where the ledger can be written to again.
class Service {
 public:
  /// `options` outlive this.
  explicit Service(const Options& options);

  /// Until SIGTERM or SIGINT: 0; 1: it could not start, and has said why.
  int run();

 private:
  void announce();
  std::expected<bool, std::string> run_one();
  std::expected<bool, std::string> run(Gateway& gateway, const settings::Settings& settings);
  void begin_watchdog();
  std::expected<void, std::string> take_over_sockets();
  std::string finish_taking_over();

  const Options& options_;
  admin::Store store_;
  admin::FactoryReset reset_;
  admin::TakingOver taking_over_;
  ListenSockets sockets_;
  loop::Loop loop_;
  loop::FileDescriptor announced_;          // to adit-panel, until its lights are opened
  std::optional<loop::Watchdog> watchdog_;  // where systemd wants one
  Gateway* running_ = nullptr;              // signals come while the loop runs, and so does it
  std::string trouble_;                     // what came of the last change
  std::optional<forward::Legacy> legacy_;
  std::chrono::seconds ledger_rest_ = LedgerReturn::kRest;
};

}  // namespace adit::gateway
