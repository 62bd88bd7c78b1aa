#include "gateway/team_address.hpp"

#include <algorithm>

#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "settings/subnet.hpp"

namespace adit::gateway {

std::string team_address(const settings::Team& team) {
  if (!team.interface.empty()) {
    const auto own = host::own_address(team.interface);
    host::log_failure(host::Level::Warning, "the team's address is unknown", own);
    return own && *own ? settings::ipv4_text((*own)->address) : "";
  }
  const auto given = std::ranges::find_if(team.listen, [](const settings::Address& each) {
    return settings::ipv4_of(each.address).value_or(0) != 0;
  });
  return given == team.listen.end() ? "" : given->address;
}

}  // namespace adit::gateway
