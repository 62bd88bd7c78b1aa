#pragma once

#include <expected>
#include <optional>
#include <string>

#include "network/messages.hpp"

namespace adit::admin {

/// How aditd speaks with adit-network: by files (firmware/network/README.md).
class NetworkRequests {
 public:
  /// `state_folder`: where requests are left; `status_folder`: where they are answered; `watch_folder`: where
  /// adit-network --watch tells what it hears.
  NetworkRequests(std::string state_folder, std::string status_folder, std::string watch_folder)
      : state_(std::move(state_folder)), status_(std::move(status_folder)), watch_(std::move(watch_folder)) {}

  /// How it stands, or why nobody says so.
  std::expected<network::Status, std::string> status() const;
  /// The last answer to a Probe, if any.
  std::optional<network::Probed> probed() const;

  /// Who else uses the box's addresses, as it was told last; nobody where nobody listens.
  network::Taken taken() const;

  std::expected<void, std::string> ask(const network::Wanted& wanted);
  std::expected<void, std::string> ask(const network::Word& word);
  std::expected<void, std::string> ask(const network::Probe& probe);
  std::expected<void, std::string> ask(const network::Endpoints& endpoints);
  std::expected<void, std::string> ask(const network::Forget& forget);
  /// It is not to be done any more, where it has not been begun.
  void forget_wanted();

 private:
  std::string state_, status_, watch_;
};

}  // namespace adit::admin
