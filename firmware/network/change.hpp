#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>

#include "network/messages.hpp"
#include "network/numbers.hpp"

namespace adit::network {

/// What is done to the machine.
class Hands {
 public:
  virtual ~Hands() = default;
  /// Uses the numbers until the machine is restarted, or until they are reverted.
  virtual std::expected<void, std::string> apply(const Numbers& numbers) = 0;
  /// Uses them from now on.
  virtual std::expected<void, std::string> keep(const Numbers& numbers) = 0;
  /// Goes back to what was kept last.
  virtual std::expected<void, std::string> revert() = 0;
  /// Goes back to what the box came with, and keeps that; gives it, where it came with any.
  virtual std::expected<std::optional<Numbers>, std::string> forget() = 0;
};

/// A change of the network's numbers. It is applied at once, stored when the operator confirms it, and
/// reverted if the operator does not confirm it in time. One at a time.
class Change {
 public:
  /// A revert that fails is tried again this often, this long after the last time; then by a later start.
  static constexpr int kTries = 5;
  static constexpr std::chrono::seconds kTryAgain{2};

  /// `hands` outlives this. `kept`: what was confirmed last, or what the box came with.
  Change(Hands& hands, const std::optional<Numbers>& kept) : hands_(hands) { status_.kept = kept; }

  void set_interfaces(std::string team, std::string command_post) {
    status_.team_interface = std::move(team);
    status_.command_post_interface = std::move(command_post);
  }

  /// A change was under way when this last ended: it has been reverted.
  void interrupted();

  void want(const Wanted& wanted, Instant now);
  /// A word counts until tick() has said that the time is up: whoever was kept from looking looks for words
  /// first, for they may have come in time.
  void hear(const Word& word, Instant now);
  /// Ends what is pending, too. An error: it is not done, or not in use yet.
  std::expected<void, std::string> forget(Instant now);
  void tick(Instant now);
  /// The program ends: reverts a pending change. If a revert has failed, tries it once more.
  void stop(Instant now);

  /// When tick() is to be called; nothing: no change is under way.
  std::optional<Instant> wake() const;
  void set_endpoints(Endpoints endpoints) { status_.endpoints = std::move(endpoints); }
  const Status& status() const { return status_; }

 private:
  void revert(std::string why, Instant now);
  void try_to_revert(Instant now);
  void end(Ended how, std::string why);

  Hands& hands_;
  Status status_;
  std::string why_;  // it is being reverted
  int tries_ = 0;
  std::optional<Instant> try_at_;
};

}  // namespace adit::network
