// access.json, sessions.json and devices.json: what lets people in; and acknowledged.json.
#include "access/accounts.hpp"

#include "access/sessions.hpp"
#include "alarms/board.hpp"
#include "target.hpp"

namespace adit::fuzz {

void try_accounts(Input text) {
  settles(text, access::read_accounts, access::write_accounts);
  settles(text, access::read_sessions, access::write_sessions);
  static const access::Accounts kAccounts{.viewer = "$y$j9T$abd$def", .operator_ = "$y$j9T$abc$def"};
  settles(
      text, [](Input json) { return access::read_devices(json, kAccounts); },
      [](const std::vector<access::Device>& devices) { return access::write_devices(devices, kAccounts); });
  settles(text, alarms::read_acknowledged, alarms::write_acknowledged);
}

}  // namespace adit::fuzz
