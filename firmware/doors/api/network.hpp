#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/status.hpp"
#include "network/check.hpp"
#include "network/numbers.hpp"

namespace adit::api {

/// An unconfirmed change.
struct PendingNetwork {
  double until = 0;  // seconds since 1970
  network::Numbers wanted;
  std::optional<network::Numbers> previous;  // the numbers after a revert; nullopt: the factory's
  std::string page;                          // address for the confirmation: "http://192.168.8.11:8000"
  static const codec::Row kRow;
};

/// The present state of one of the box's two ports.
struct PortRow {
  std::string side, interface;  // side: "team", "command_post"
  std::string mac;              // "": no such interface
  std::vector<std::string> addresses;
  std::string name;             // mDNS name on this side: "adit.local"; "" except for the team
  std::optional<bool> carrier;  // nullopt: no such interface
  std::optional<std::uint32_t> mbit;
  std::string duplex;
  static const codec::Row kRow;
};

/// The box's addresses, and an unconfirmed change.
struct NetworkView {
  double now = 0;          // the box's time of day; seconds since 1970
  bool managed = false;    // whether they can be changed here
  std::string why;         // why not, or ""
  bool runs_here = false;  // whether adit-network runs, is starting, or has an unreadable status
  std::string team_interface, command_post_interface;
  /// The interfaces' present addresses, from any source.
  std::optional<settings::Subnet> team;  // the first
  std::vector<settings::Subnet> command_post;
  /// Confirmed, or from the factory.
  network::Mode mode = network::Mode::Static;
  std::optional<std::uint32_t> gateway;

  std::optional<PendingNetwork> pending;
  std::vector<PortRow> ports;  // those in the settings that can be read; else `why` has the reason
  std::string last;            // "confirmed", "reverted", or "" before a change since the start
  std::string last_why;        // its reason
  static const codec::Row kRow;
};

/// Changes the addresses. A refusal says why not.
class Network {
 public:
  virtual ~Network() = default;
  virtual NetworkView state() const = 0;
  /// `asker`: the client's address.
  virtual network::Findings check(const network::Numbers& wanted, const std::string& asker) const = 0;
  /// Applies numbers that passed check(), until confirmed or reverted. adit-network checks them again.
  virtual icd::Checked<void> change(const network::Numbers& wanted) = 0;
  /// `local`: the box's address in this connection. It must be the new one, which proves that users reach it.
  virtual icd::Checked<void> confirm(const std::string& local) = 0;
  virtual icd::Checked<void> revert() = 0;
};

}  // namespace adit::api
