#pragma once

#include <optional>
#include <string>

#include "alarms/facts.hpp"
#include "api/network.hpp"
#include "host/root_program.hpp"
#include "loop/loop.hpp"
#include "network/messages.hpp"
#include "settings/settings.hpp"

namespace adit::admin {

/// The operator's changes of the box's own addresses, as adit-network makes them.
class NetworkChange final : public api::Network {
 public:
  /// adit-network asks the network first whether an address is free, which takes some seconds.
  static constexpr std::chrono::seconds kTakenUpWithin{30};
  /// adit-network is told again where the endpoints are, where it does not know, this long after the last
  /// time.
  static constexpr std::chrono::seconds kTellAgain{10};

  /// `watch_folder`: where adit-network --watch tells what it hears. All others outlive this.
  NetworkChange(loop::Loop& loop, const settings::Settings& settings,
                host::RootProgram<network::Status>& adit_network, const std::string& watch_folder)
      : loop_(loop),
        settings_(settings),
        adit_network_(adit_network),
        taken_file_(watch_folder + '/' + network::kTakenFile) {}

  api::NetworkView network() const override;
  network::Findings check(const network::Numbers& wanted, const std::string& asker) const override;
  icd::Checked<void> change(const network::Numbers& wanted) override;
  icd::Checked<void> confirm(const std::string& local) override;
  icd::Checked<void> revert() override;

  /// Called each second. Takes note of what became of the last change, and sees to it that there are ways to
  /// the endpoints of the settings, and of all courses.
  void every_second();
  /// Who answers for an endpoint on the Command Post's side: it, or the gateway to it; "": there is no way to
  /// it.
  std::string next_hop(const settings::Address& endpoint) const;

  /// What is to be known of the addresses at once.
  alarms::NetworkFact fact() const;

 private:
  /// Reads the watch's file if the last reading is old. If the file cannot be read, the last known addresses
  /// stay for network::kTakenFor.
  void read_taken() const;
  void lead_to_endpoints();
  std::optional<alarms::ExchangedAddress> exchanged() const;
  std::optional<alarms::TakenAddress> taken(const std::string& interface, bool is_team) const;
  /// Why nothing can be changed here; "" where it can.
  std::string hindrance() const;
  std::string page_at(const network::Numbers& numbers) const;
  std::optional<network::Pending> pending() const;
  std::optional<network::Numbers> kept() const;
  std::optional<network::Numbers> present() const;
  /// Where `local` is an address by which the confirmation of a change to `wanted` may come.
  icd::Checked<void> check_confirmable(const network::Numbers& wanted, const std::string& local) const;
  icd::Checked<void> say(network::Word::What what, const network::Pending& pending) const;

  loop::Loop& loop_;
  const settings::Settings& settings_;
  host::RootProgram<network::Status>& adit_network_;
  const std::string taken_file_;
  mutable network::Taken taken_;
  mutable std::string taken_trouble_;  // why the file could not be read last, which is logged once
  mutable std::optional<loop::Instant> taken_read_at_;
  network::Wanted wanted_;  // last
  loop::Instant wanted_at_{};
  std::optional<loop::Instant> told_at_;  // where the endpoints are
};

}  // namespace adit::admin
