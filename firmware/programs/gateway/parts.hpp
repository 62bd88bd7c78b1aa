#pragma once

#include <chrono>
#include <expected>
#include <memory>
#include <string>

#include "admin/factory_reset.hpp"
#include "admin/store.hpp"
#include "admin/takeover.hpp"
#include "gateway/listen_sockets.hpp"
#include "gateway/options.hpp"
#include "host/disk.hpp"
#include "ledger/ledger.hpp"
#include "panel/lines.hpp"
#include "settings/board.hpp"

namespace adit::gateway {

/// Checked parts of a gateway.
struct Parts {
  const Options& options;      // outlives the gateway
  admin::Store& store;         // outlives the gateway
  admin::FactoryReset& reset;  // outlives the gateway
  admin::Takeover& takeover;   // outlives the gateway
  ListenSockets& sockets;      // outlives the gateway
  admin::Store::Loaded loaded;
  std::string trouble;    // why other settings are in use than wanted, or ""
  std::string put_aside;  // queued messages put aside, and why; or ""
  std::string stuck;      // why a take-over is unfinished and the box stands by, or ""
  ledger::Ledger ledger;
  std::expected<host::Wear, std::string> wear;  // of the state directory's disk
  std::chrono::seconds file_rest;               // until unreadable files are tried again
  settings::Board board;
  std::string board_trouble;  // why the board's file is ignored, or ""
  std::unique_ptr<panel::Lines> lines;
  std::unique_ptr<panel::ButtonLine> button;  // null: no button
  std::string runtime_folder;
};

}  // namespace adit::gateway
