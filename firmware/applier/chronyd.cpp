#include "applier/chronyd.hpp"

#include <array>
#include <chrono>
#include <utility>

#include "host/log.hpp"
#include "host/output.hpp"
#include "host/service.hpp"

namespace adit::applier {
namespace {

constexpr const char* kUnit = "adit-ntp.service";
constexpr std::chrono::seconds kUnitAnswer{20};

std::array<std::pair<const char*, const std::string*>, 3> files_of(const clock::Chrony& chrony) {
  return {{{clock::kOptionsFile, &chrony.options},
           {clock::kFirewallFile, &chrony.firewall},
           {clock::kConfigurationFile, &chrony.configuration}}};  // last: marks the others complete
}

}  // namespace

std::string Chronyd::run_with(const clock::Ntp& ntp, clock::Source source) const {
  return ntp.is_on() ? start(clock::chrony_for(ntp, source, interface_)) : stop();
}

std::string Chronyd::start(const clock::Chrony& chrony) const {
  bool is_as_it_was = true;
  for (const auto& [name, text] : files_of(chrony))
    is_as_it_was = is_as_it_was && host::read_file(path(name)) == *text;
  if (is_as_it_was) return "";
  (void)host::remove_file(
      path(clock::kConfigurationFile));  // after a death here, the next request starts chronyd
  for (const auto& [name, text] : files_of(chrony)) {
    if (const auto written = host::write_file(path(name), *text, host::kForAll); !written)
      return written.error();
  }
  const auto started = host::run_command({systemctl_, "restart", kUnit}, kUnitAnswer);
  if (started) {
    host::log(host::Level::Notice, "NTP is on in the team's network");
    return "";
  }
  (void)host::remove_file(path(clock::kConfigurationFile));
  return "cannot start chronyd: " + started.error();
}

std::string Chronyd::stop() const {
  if (!host::may_exist(path(clock::kConfigurationFile))) return "";
  const auto stopped = host::run_command({systemctl_, "stop", kUnit}, kUnitAnswer);
  if (!stopped) return "cannot stop chronyd: " + stopped.error();
  host::log(host::Level::Notice, "NTP is off");
  const auto removed = host::remove_file(path(clock::kConfigurationFile));
  return removed ? "" : removed.error();
}

}  // namespace adit::applier
