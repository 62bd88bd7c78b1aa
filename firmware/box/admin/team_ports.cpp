#include "admin/team_ports.hpp"

#include <algorithm>
#include <iterator>

#include "host/log.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"

namespace adit::admin {

/// Without a file, the firewall's first ports are open. They may be more than `ports`, as before any request.
bool TeamPorts::are_open(const network::TeamPorts& ports) const {
  const auto rules = host::read_optional_file(rules_ + '/' + network::kPortRulesFile);
  if (rules && *rules) return **rules == network::rules_for(ports);
  return rules && std::ranges::all_of(ports.ports, [](std::uint16_t port) {
           return std::ranges::find(network::kFirstTeamPorts, port) != std::end(network::kFirstTeamPorts);
         });
}

void TeamPorts::every_second(const network::TeamPorts& ports) {
  if (are_open(ports)) {
    asked_at_.reset();
    return;
  }
  if (asked_at_ && asked_ == ports &&
      (loop_.now() < *asked_at_ + kAskAgain || host::can_exist(state_ + '/' + network::kPortsFile)))
    return;
  asked_ = ports;
  asked_at_ = loop_.now();
  host::log_failure(host::Level::Error, "cannot request ports",
                    host::write_request(state_, network::kPortsFile, ports));
}

}  // namespace adit::admin
