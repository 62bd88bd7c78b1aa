// access.json, sessions.json and devices.json: what lets people in; tls.pem; and acknowledged.json.
#include "access/accounts.hpp"

#include "access/certificate.hpp"
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
  settles(text, access::read_pem, [](const access::KeyAndChain& pem) {
    const std::size_t size = access::fingerprint_of(pem).size();
    require(size == 0 || size == 95);
    return pem.text();
  });
  settles(text, alarms::read_acknowledged, alarms::write_acknowledged);
}

}  // namespace adit::fuzz
