#pragma once

#include <optional>
#include <string>

#include "admin/network_requests.hpp"
#include "alarms/facts.hpp"
#include "api/network.hpp"
#include "loop/loop.hpp"
#include "settings/settings.hpp"

namespace adit::admin {

/// The operator's changes of the box's own addresses, as adit-network makes them.
class NetworkChange final : public api::Network {
 public:
  /// adit-network asks the network first whether an address is free, which takes some seconds.
  static constexpr std::chrono::seconds kTakenUpWithin{30};
  /// How old what was read of its status, and of the watch, may be.
  static constexpr std::chrono::milliseconds kFresh{50};
  /// adit-network is told again where the endpoints are, where it does not know, this long after the last
  /// time.
  static constexpr std::chrono::seconds kTellAgain{10};

  /// All outlive this.
  NetworkChange(loop::Loop& loop, const settings::Settings& settings, NetworkRequests& requests)
      : loop_(loop), settings_(settings), requests_(requests) {}

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
  /// What was asked for and is not in the status yet.
  struct Asked {
    network::Wanted wanted;
    loop::Instant at;
  };
  /// Reads the status again where what is known of it is old.
  void refresh() const;
  /// Whether what was asked for is not in the status yet, and may still be.
  bool is_asked() const;
  void note_what_became_of_it();
  void lead_to_endpoints();
  std::optional<alarms::ExchangedAddress> exchanged() const;
  std::optional<alarms::TakenAddress> taken(const std::string& interface, bool is_team) const;
  /// Why nothing can be changed here; "" where it can.
  std::string hindrance() const;
  std::string page_at(const network::Numbers& numbers) const;
  std::optional<network::Pending> pending() const;
  std::optional<network::Numbers> present() const;
  /// Where `local` is an address by which the confirmation of a change to `wanted` may come.
  icd::Checked<void> check_confirmable(const network::Numbers& wanted, const std::string& local) const;
  icd::Checked<void> say(network::Word::What what, const network::Pending& pending) const;

  loop::Loop& loop_;
  const settings::Settings& settings_;
  NetworkRequests& requests_;
  mutable std::expected<network::Status, std::string> status_;
  mutable network::Taken taken_;
  mutable std::optional<loop::Instant> read_at_;
  std::optional<Asked> asked_;            // its last word is had by is_asked()
  std::optional<loop::Instant> told_at_;  // where the endpoints are
  std::string not_taken_up_;              // why the last change came to nothing
};

}  // namespace adit::admin
