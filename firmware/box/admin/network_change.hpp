#pragma once

#include <expected>
#include <optional>
#include <string>

#include "api/network.hpp"
#include "facts/snapshot.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"
#include "settings/settings.hpp"

namespace adit::admin {

/// The operator's changes of the box's addresses, executed by adit-network.
class NetworkChange final : public api::Network {
 public:
  /// adit-network first probes the network for the addresses, which takes seconds.
  static constexpr std::chrono::seconds kTakenUpWithin{30};
  /// Interval at which adit-network is sent the endpoints until its status has them.
  static constexpr std::chrono::seconds kTellAgain{10};

  /// `watch_folder`: of adit-network --watch. The other arguments must outlive this object.
  NetworkChange(loop::Loop& loop, const settings::Settings& settings,
                host::RootProgram<network::Status>& adit_network, const std::string& watch_folder)
      : loop_(loop),
        settings_(settings),
        adit_network_(adit_network),
        taken_file_(watch_folder + '/' + network::kTakenFile) {}

  api::NetworkView state() const override;
  network::Findings check(const network::Numbers& wanted, const std::string& asker) const override;
  icd::Checked<void> change(const network::Numbers& wanted) override;
  icd::Checked<void> confirm(const std::string& local) override;
  icd::Checked<void> revert() override;

  /// Call each second. Reads the last change's result, requests routes to settings' and courses' endpoints.
  void every_second();
  /// The host for an endpoint: itself or its gateway. "": no route. Error: the box's addresses are unknown.
  std::expected<std::string, std::string> next_hop(const settings::Address& endpoint) const;

  /// Asks adit-network who else has the address of `interface`, on the Command Post's side, and at which port
  /// the next hop to `endpoint` answers. Error: why it cannot ask.
  std::expected<network::Probe, std::string> probe(const std::string& interface,
                                                   const settings::Address& endpoint) const;
  /// The answer to `probe`. nullopt: not yet there. Error: it cannot be read.
  std::expected<std::optional<network::ProbeResult>, std::string> answer_to(
      const network::Probe& probe) const;

  /// Input of the alarm rules.
  facts::Network fact() const;

 private:
  /// Reads the watch's file if the last reading is old. If it fails, addresses stay for network::kTakenFor.
  void read_taken() const;
  void lead_to_endpoints();
  std::optional<facts::SwappedAddress> swapped_address() const;
  std::optional<facts::AddressConflict> address_conflict(const std::string& interface, bool is_team) const;
  /// Why changes are impossible here, or "".
  std::string refusal_reason() const;
  std::string page_at(const network::Numbers& numbers) const;
  std::optional<network::Pending> pending() const;
  std::optional<network::Numbers> confirmed_numbers() const;
  /// Error: no numbers are confirmed, and the box's addresses cannot be read.
  std::expected<std::optional<network::Numbers>, std::string> present() const;
  /// Accepts `local` if a change to `wanted` may be confirmed from that address.
  icd::Checked<void> check_confirmable(const network::Numbers& wanted, const std::string& local) const;
  icd::Checked<void> send_decision(network::Decision::Command what, const network::Pending& pending) const;

  loop::Loop& loop_;
  const settings::Settings& settings_;
  host::RootProgram<network::Status>& adit_network_;
  const std::string taken_file_;
  mutable network::AddressConflicts taken_;
  mutable std::string taken_trouble_, hop_trouble_;  // the last read errors, logged once
  mutable std::optional<loop::Instant> taken_read_at_;
  network::ChangeRequest wanted_;  // last request
  loop::Instant wanted_at_{};
  std::optional<loop::Instant> told_at_;  // last request for routes
};

}  // namespace adit::admin
