#include "applier/team_ports.hpp"

#include "host/log.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "network/messages.hpp"

namespace adit::applier {

std::expected<void, std::string> write_port_rules(const Options& options) {
  auto folder = ADIT_TRY(host::open_requests(options.wanted));
  while (folder) {
    const auto wanted = ADIT_TRY(host::take_request<network::TeamPorts>(*folder, network::kPortsFile));
    if (!wanted) break;
    const std::string rules = network::rules_for(*wanted);
    ADIT_TRY(host::write_file(options.status + '/' + network::kPortRulesFile, rules, host::kForAll));
    std::string ports;
    for (const std::uint16_t port : wanted->ports) ports += icd::sentence(ports.empty() ? "" : " ", port);
    host::log(host::Level::Notice, "ports of the team's side", {{"ports", ports}});
  }
  return {};
}

}  // namespace adit::applier
