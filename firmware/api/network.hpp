#pragma once

#include <optional>
#include <string>
#include <vector>

#include "codec/row.hpp"
#include "icd/status.hpp"
#include "network/check.hpp"
#include "network/numbers.hpp"

namespace adit::api {

/// A change that waits to be confirmed.
struct PendingNetwork {
  double until = 0;  // seconds since 1970
  network::Numbers wanted;
  std::optional<network::Numbers> previous;  // what it goes back to; nothing: as the box came
  std::string page;                          // where to confirm it: "http://192.168.8.11:8000"
  static const codec::Row kRow;
};

/// One of the box's two ports, as the kernel has it now.
struct PortRow {
  std::string side, interface;  // side: "team", "command_post"
  std::string mac;              // "": there is no such interface
  std::vector<std::string> addresses;
  std::string name;  // that finds it from this side: "adit.local"; "": none, only the team's has one
  std::optional<bool> carrier;  // nothing: there is no such interface
  std::optional<std::uint32_t> mbit;
  std::string duplex;
  static const codec::Row kRow;
};

/// The box's own addresses, and a change of them that waits to be confirmed.
struct NetworkView {
  double now = 0;        // the box's time of day; seconds since 1970
  bool managed = false;  // they can be changed here
  std::string why;       // why not; "" where they can
  std::string team_interface, command_post_interface;
  /// What the interfaces have now, whoever set it.
  std::optional<settings::Subnet> team;  // the first
  std::vector<settings::Subnet> command_post;
  /// As they were confirmed, or the factory's.
  network::Mode mode = network::Mode::Static;
  std::optional<std::uint32_t> gateway;

  std::optional<PendingNetwork> pending;
  std::vector<PortRow> ports;  // those that the settings name
  std::string last;            // "confirmed" or "reverted"; "" where none was made since the box started
  std::string last_why;        // of it
  static const codec::Row kRow;
};

/// What changes them. A refusal says why not.
class Network {
 public:
  virtual ~Network() = default;
  virtual NetworkView network() const = 0;
  /// `asker`: the address of whoever asks.
  virtual network::Findings check(const network::Numbers& wanted, const std::string& asker) const = 0;
  /// The numbers have passed check(); adit-network checks them again. They are tried at once, and wait to be
  /// confirmed.
  virtual icd::Checked<void> change(const network::Numbers& wanted) = 0;
  /// `local`: the box's address by which the confirmation came. It must be the new one: nobody can confirm an
  /// address that he cannot reach.
  virtual icd::Checked<void> confirm(const std::string& local) = 0;
  virtual icd::Checked<void> revert() = 0;
};

}  // namespace adit::api
