#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <vector>

#include "network/messages.hpp"
#include "network/numbers.hpp"

namespace adit::network {

/// The actions of a Change on the machine.
class NumbersSetter {
 public:
  virtual ~NumbersSetter() = default;
  /// Uses the numbers until the next boot or the next revert().
  virtual std::expected<void, std::string> apply(const Numbers& numbers) = 0;
  /// Uses and stores the numbers.
  virtual std::expected<void, std::string> keep(const Numbers& numbers) = 0;
  /// Returns to the numbers that were stored last.
  virtual std::expected<void, std::string> revert() = 0;
  /// Returns to the factory numbers, stores them, and gives them. std::nullopt: the box came without any.
  virtual std::expected<std::optional<Numbers>, std::string> forget() = 0;
};

/// A change of the network's numbers, one at a time. It is applied at once and stored when the operator
/// confirms it. If the operator does not confirm it in time, it is reverted.
class Change {
 public:
  /// Attempts of a failing revert, and the wait between them. After the last one, a later start reverts.
  static constexpr int kTries = 5;
  static constexpr std::chrono::seconds kTryAgain{2};

  /// `hands` must outlive this object. `kept`: the numbers that were confirmed last, or the factory numbers.
  Change(NumbersSetter& hands, const std::optional<Numbers>& kept) : hands_(hands) { status_.kept = kept; }

  void set_interfaces(std::string team, std::string command_post) {
    status_.team_interface = std::move(team);
    status_.command_post_interface = std::move(command_post);
  }

  /// Records that the previous process ended during a change. The caller has reverted that change.
  void on_interrupted();

  void request_change(const ChangeRequest& wanted, Instant now);
  /// Confirms or reverts the change. Call before tick(): a late caller may hold a word that came in time.
  void decide(const Decision& word, Instant now);
  /// Forgets all addresses and ends a pending change. Error: not done, or not in effect yet.
  std::expected<void, std::string> forget(Instant now);
  void tick(Instant now);
  /// Reverts a pending change before the program ends. If a revert has failed, tries once more.
  void stop(Instant now);

  /// Time of the next tick(). std::nullopt: no change is pending.
  std::optional<Instant> wake() const;
  void set_endpoints(Endpoints endpoints) { status_.endpoints = std::move(endpoints); }
  const Status& status() const { return status_; }

 private:
  void revert(std::string why, Instant now);
  void try_to_revert(Instant now);
  void end(ChangeOutcome how, std::string why);

  NumbersSetter& hands_;
  Status status_;
  std::string why_;  // reason of the revert
  int tries_ = 0;
  std::optional<Instant> try_at_;
};

/// The routing table of the Command Post's routes. Only sockets bound to its interface or to one of its
/// addresses use it. So traffic to the team never uses these routes, even if both sides' subnets overlap.
inline constexpr int kRouteTable = 230;

/// The systemd.network(5) file of the team's side: its address, a link-local address and mDNS. DHCP sets only
/// the address: no route, name server or time.
std::string team_file(const std::string& interface, const Numbers& numbers);
/// The systemd.network(5) file of the Command Post's side: the addresses, and routes by the gateway to
/// `endpoints` outside their subnets. It has no default route, because the two networks meet only inside
/// Adit. The interface accepts no configuration from the network and sends no announcements.
std::string command_post_file(const std::string& interface, const Numbers& numbers,
                              const std::vector<std::uint32_t>& endpoints);

/// File names: the lower number wins. A change on trial precedes the stored numbers, and both precede the
/// machine's earlier files (netplan's 10-*), which may match an interface by its old name.
inline constexpr const char* kTriedTeam = "04-adit-team.network";
inline constexpr const char* kTriedCommandPost = "04-adit-command-post.network";
inline constexpr const char* kKeptTeam = "05-adit-team.network";
inline constexpr const char* kKeptCommandPost = "05-adit-command-post.network";

}  // namespace adit::network
