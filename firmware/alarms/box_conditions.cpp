// What is wrong with the box and its networks.
#include <algorithm>
#include <cmath>

#include "alarms/conditions.hpp"
#include "alarms/found.hpp"
#include "alarms/words.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using icd::sentence;

const Action kOpenSetUp{"Open set-up", "/setup"};
const Action kOpenNetwork{"Open set-up", "/setup#network"};
const Action kOpenSystem{"Open system", "/system"};

void find_pending_change(const NetworkFact& network, Found& found) {
  if (!network.confirm_within) return;
  const auto left = static_cast<std::int64_t>(std::ceil(*network.confirm_within));
  found.push_back(
      {.id = "network_change",
       .severity = Severity::Ask,
       .side = Side::Network,
       .what = "A network change is waiting",
       .why = left > 0 ? sentence("confirm within ", left, " s at ", network.page) : "it is being taken back",
       .action = {"Confirm", left > 0 ? network.page : "/setup#network"}});
}

std::string side_of(bool is_team) {
  return is_team ? "team" : "command_post";
}

void find_cables(const Facts& facts, Found& found) {
  for (const Cable& cable : facts.cables) {
    if (cable.carrier.value_or(false)) continue;
    const std::string side = side_of(cable.is_team);
    const std::string whose = cable.is_team ? "The team's" : "The Command Post's";
    Condition condition{.id = "cable_out:" + side, .side = Side::Network, .subject = side};
    if (cable.carrier) {
      condition.what = whose + " cable is out";
      condition.why = cable.interface + " has no carrier";
    } else {
      condition.what = "There is no interface " + cable.interface;
      condition.why = "set-up names it for the " + std::string(cable.is_team ? "team" : "Command Post");
      condition.action = kOpenSetUp;
    }
    found.push_back(std::move(condition));
  }
}

/// Whether an endpoint of the Command Post is known to be heard, by its own port.
bool is_heard(const Endpoint& endpoint) {
  return endpoint.trouble != PostTrouble::NoToken && endpoint.trouble != PostTrouble::Unreachable &&
         endpoint.trouble != PostTrouble::Silent;
}

void find_exchanged_cables(const Facts& facts, Found& found) {
  const auto& exchanged = facts.network.exchanged;
  if (!exchanged || std::ranges::any_of(facts.endpoints, is_heard)) return;
  found.push_back({.id = "cables_exchanged",
                   .side = Side::Network,
                   .what = "The two cables are exchanged",
                   .why = sentence(exchanged->address, " is at ", exchanged->found_on, " and not at ",
                                   exchanged->sought_on)});
}

void find_addresses(const Facts& facts, Found& found) {
  const NetworkFact& network = facts.network;
  if (network.no_address) {
    found.push_back({.id = "no_address",
                     .side = Side::Box,
                     .what = "The box has no address upstream",
                     .why = "set one in the Command Post's subnet",
                     .action = kOpenNetwork});
  }
  for (const TakenAddress& taken : network.taken) {
    const std::string side = side_of(taken.is_team);
    found.push_back({.id = "address_taken:" + side,
                     .side = Side::Network,
                     .subject = side,
                     .what = "Our address is taken",
                     .why = sentence(taken.address, " on ", taken.interface, " is also ", taken.mac,
                                     "'s: are a box and its spare both in? unplug one, or change an address"),
                     .action = kOpenNetwork});
  }
}

void add(Found& found, const std::string& trouble, Condition condition) {
  if (trouble.empty()) return;
  condition.side = Side::Box;
  condition.why += trouble;
  found.push_back(std::move(condition));
}

void find_disk_troubles(const Facts& facts, Found& found) {
  add(found, facts.ledger_refusal,
      {.id = "ledger_unwritable",
       .what = "No report is taken",
       .why = "the ledger cannot be written: ",
       .action = kOpenSystem});
  add(found, facts.ledger_damage,
      {.id = "ledger_damaged", .severity = Severity::Ask, .what = "The ledger was damaged"});
  add(found, facts.disk.map, {.id = "map_not_kept", .what = "The last map was not taken"});
  add(found, facts.disk.state,
      {.id = "state_not_kept", .what = "States and markers are not taken", .why = "they cannot be kept: "});
  add(found, facts.disk.run,
      {.id = "run_not_kept",
       .what = "The run's map is not kept",
       .why = "it and the tracks will not outlive a restart: "});
  if (facts.disk.free && *facts.disk.free < kLeastFree) {
    found.push_back({.id = "disk_full",
                     .side = Side::Box,
                     .what = "The disk is nearly full",
                     .why = sentence(*facts.disk.free >> 10, " kB are free for reports"),
                     .action = kOpenSystem});
  }
}

/// "the last change was taken back: binding to..." in its two parts.
void find_change_trouble(const std::string& trouble, Found& found) {
  if (trouble.empty()) return;
  const std::size_t colon = trouble.find(": ");
  const std::string what = trouble.substr(0, colon);
  found.push_back({.id = "settings_not_changed",
                   .side = Side::Box,
                   .what = capital(what),
                   .why = colon == std::string::npos ? "" : trouble.substr(colon + 2),
                   .action = kOpenSetUp});
}

void find_update_troubles(const UpdateFact& update, Found& found) {
  if (update.on_trial) {
    found.push_back({.id = "update_on_trial",
                     .severity = Severity::Wait,
                     .side = Side::Box,
                     .subject = update.version,
                     .what = sentence("Version ", update.version, " is on trial"),
                     .why = "leave the power on until it has shown that it works",
                     .action = kOpenSystem});
  }
  add(found, update.stray,
      {.id = "other_slot",
       .severity = Severity::Ask,
       .what = "Another slot is running",
       .action = kOpenSystem});
}

}  // namespace

void find_network_troubles(const Facts& facts, Found& found) {
  find_pending_change(facts.network, found);
  find_cables(facts, found);
  find_exchanged_cables(facts, found);
  find_addresses(facts, found);
}

void find_box_troubles(const Facts& facts, Found& found) {
  add(found, facts.rests,
      {.id = "rests",
       .what = "This box rests and sends nothing",
       .action = {"Open system", "/system#spare"}});
  find_disk_troubles(facts, found);
  if (!facts.time_set.value_or(true)) {
    found.push_back({.id = "time_not_set",
                     .severity = Severity::Wait,
                     .side = Side::Box,
                     .what = "The box's time is not set",
                     .why = "times and logs are of a wrong day: log in, or adit clock set",
                     .action = kOpenSystem});
  }
  add(found, facts.ntp_trouble,
      {.id = "ntp",
       .severity = Severity::Wait,
       .side = Side::Box,
       .what = "NTP does not work",
       .action = kOpenSetUp});
  find_change_trouble(facts.change_trouble, found);
  add(found, facts.settings_trouble,
      {.id = "settings_not_used", .what = "The saved settings are not used", .action = kOpenSetUp});
  add(found, facts.board_trouble, {.id = "board_not_used", .what = "The board's file is not used"});
  add(found, facts.lights_trouble,
      {.id = "lights_not_set", .what = "The lights are not to be trusted", .why = "they cannot be set: "});
  for (const auto& [name, why] : facts.notices)
    add(found, why, {.id = "notice:" + name, .subject = name, .what = "The box is not well"});
  find_update_troubles(facts.update, found);
}

}  // namespace adit::alarms
