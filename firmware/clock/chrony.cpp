#include "clock/chrony.hpp"

#include "icd/require.hpp"
#include "icd/sentence.hpp"

namespace adit::clock {
namespace {

/// Lets aditd on this machine ask for the state of chronyd, not command it.
constexpr const char* kTells =
    "cmdport 323\nbindcmdaddress 127.0.0.1\nbindcmdaddress /\npidfile /run/adit-ntp/chronyd.pid\n";

}  // namespace

Chrony chrony_for(const Ntp& ntp, Source source, const std::string& interface) {
  icd::require(ntp.is_on());
  const bool keeps = source == Source::Ntp && !ntp.server.empty();
  const bool gives = is_set(source) && !ntp.clients.empty();
  Chrony chrony{.configuration = "# By adit-clock, of Adit's settings: chrony.conf(5)\n",
                .options = keeps ? "CHRONYD=\n" : "CHRONYD=-x\n",
                .firewall = "flush set inet adit ntp_servers\nflush set inet adit ntp_clients\n"};
  std::string& text = chrony.configuration;
  text += icd::sentence("bindacqdevice ", interface, "\nbinddevice ", interface, "\n", kTells);
  if (!ntp.server.empty()) {
    text += icd::sentence("server ", ntp.server, " iburst minpoll 3 maxpoll 5\nmakestep 0.1 -1\n");
    chrony.firewall += icd::sentence("add element inet adit ntp_servers { ", ntp.server, " }\n");
  }
  if (keeps) text += "maxchange 60 0 -1\nrtcsync\n";
  if (gives) {
    text += icd::sentence("allow ", ntp.clients, "\nlocal stratum 10\n");
    chrony.firewall += icd::sentence("add element inet adit ntp_clients { ", ntp.clients, " }\n");
  } else {
    text += "port 0\n";
  }
  return chrony;
}

}  // namespace adit::clock
