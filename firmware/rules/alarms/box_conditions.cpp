// Conditions of the box and its networks.
#include <algorithm>
#include <cmath>

#include "alarms/alarm.hpp"
#include "alarms/conditions.hpp"
#include "icd/sentence.hpp"

namespace adit::alarms {
namespace {

using facts::Traffic;
using icd::sentence;

const Action kOpenSetUp{"Open set-up", "/setup"};
const Action kOpenNetwork{"Open set-up", "/setup#network"};
const Action kOpenSystem{"Open system", "/system"};

void find_pending_change(const facts::Network& network, Conditions& found) {
  if (!network.confirm_within) return;
  const auto left = static_cast<std::int64_t>(std::ceil(*network.confirm_within));
  found.push_back({.id = "network_change",
                   .severity = Severity::Ask,
                   .side = Side::Network,
                   .headline = {"A network change", "unconfirmed"},
                   .why = left > 0 ? sentence("confirm it within ", left, " s at ", network.page)
                                   : "the box is returning to the old addresses",
                   .action = {"Confirm", left > 0 ? network.page : "/setup#network"}});
}

std::string side_of(bool is_team) {
  return is_team ? "team" : "command_post";
}

void find_cables(const Traffic& traffic, Conditions& found) {
  for (const facts::LinkRow& link : traffic.links) {
    if (link.carrier.value_or(false)) continue;
    const std::string side = link.side;
    const std::string whose = link.is_team() ? "Team" : "Command Post";
    Condition condition{.id = "cable_out:" + side, .side = Side::Network, .subject = side};
    if (link.carrier) {
      condition.headline = {whose + " cable", "unplugged"};
      condition.why = link.interface + " has no link";
    } else {
      condition.headline = {"Interface " + link.interface, "missing"};
      condition.why = "set-up names it for the " + std::string(link.is_team() ? "team" : "Command Post");
      condition.action = {"Open set-up", sentence("/setup?setting=", side, ".interface#all")};
    }
    found.push_back(std::move(condition));
  }
}

/// Whether packets from the endpoint arrive, by the state of its connections.
bool is_heard(const facts::EndpointRow& endpoint) {
  return endpoint.fault != facts::EndpointFault::NoToken &&
         endpoint.fault != facts::EndpointFault::Unreachable &&
         endpoint.fault != facts::EndpointFault::Silent;
}

void find_exchanged_cables(const facts::Network& network, const Traffic& traffic, Conditions& found) {
  const auto& exchanged = network.exchanged;
  if (!exchanged || std::ranges::any_of(traffic.endpoints, is_heard)) return;
  found.push_back({.id = "cables_exchanged",
                   .side = Side::Network,
                   .headline = {"The two cables", "exchanged", true},
                   .why = sentence(exchanged->address, " answers on ", exchanged->found_on, " instead of ",
                                   exchanged->sought_on)});
}

void find_addresses(const facts::Network& network, Conditions& found) {
  if (network.no_address) {
    found.push_back({.id = "no_address",
                     .side = Side::Box,
                     .headline = {"The upstream address", "missing"},
                     .why = "set an address in the Command Post's subnet",
                     .action = kOpenNetwork});
  }
  for (const facts::AddressConflict& taken : network.taken) {
    const std::string side = side_of(taken.is_team);
    found.push_back({.id = "address_taken:" + side,
                     .side = Side::Network,
                     .subject = side,
                     .headline = {"The box's address", "in conflict"},
                     .why = sentence(taken.mac, " also uses ", taken.address, " on ", taken.interface,
                                     "; is a spare box plugged in?"),
                     .action = kOpenNetwork});
  }
}

void add(Conditions& found, const std::string& trouble, Condition condition) {
  if (trouble.empty()) return;
  condition.side = Side::Box;
  condition.why += trouble;
  found.push_back(std::move(condition));
}

void find_wear(const facts::Disk& disk, Conditions& found) {
  if (disk.life >= kWornLife || disk.spares >= kWornSpares) {
    found.push_back({.id = "disk_health",
                     .severity = Severity::Ask,
                     .side = Side::Box,
                     .headline = {"The disk", "nearly worn out"},
                     .why = disk.life > kWornLife    ? "its expected life is over"
                            : disk.life == kWornLife ? "90 % of its life is used"
                                                     : "80 % of its spare blocks are used",
                     .degree = disk.life + disk.spares});
  }
  add(found, disk.wear_unknown,
      {.id = "disk_health", .severity = Severity::Wait, .headline = {"The disk's health", "unknown"}});
}

bool is_scarce(const facts::Disk& disk) {
  return disk.free && *disk.free < kLeastFree;
}

/// "" if the disk has room.
std::string scarcity_of(const facts::Disk& disk) {
  if (!is_scarce(disk)) return "";
  const std::uint64_t left = *disk.free / 1000;
  return left == 0 ? "the disk is full" : sentence("only ", left, " kB of the disk are free");
}

std::string unstored_run_text(const facts::Disk& disk) {
  return disk.run.empty() ? "" : "the run's map is not stored, so a restart would lose it: " + disk.run;
}

/// One alarm for a scarce disk, which names its consequences. A ledger that cannot be read, and messages in
/// memory, need other remedies, so they keep their own alarms.
void find_scarce_disk(const facts::Box& box, Conditions& found) {
  const bool is_full = *box.disk.free < 1000;
  const std::string run = unstored_run_text(box.disk);
  Condition condition{.id = "disk_full",
                      .side = Side::Box,
                      .headline = {"The disk", is_full ? "full" : "nearly full"},
                      .why = is_full ? "no space is left for reports"
                                     : sentence(*box.disk.free / 1000, " kB are free for reports"),
                      .action = kOpenSystem,
                      .degree = is_full};
  if (!box.ledger_refusal.empty() && !box.ledger_is_closed) {
    condition.id = "ledger_unwritable";
    condition.headline = {"Reports", "not accepted", true};
    condition.why = scarcity_of(box.disk) + "; the box cannot write the ledger: " + box.ledger_refusal;
    condition.hides = 1;
  }
  if (!run.empty()) {
    condition.why += "; " + run;
    ++condition.hides;
  }
  condition.degree += condition.hides;
  found.push_back(std::move(condition));
}

void find_disk_troubles(const facts::Box& box, Conditions& found) {
  const bool scarce = is_scarce(box.disk);
  if (!scarce || box.ledger_is_closed) {
    add(found, box.ledger_refusal,
        {.id = "ledger_unwritable",
         .headline = {"Reports", "not accepted", true},
         .why = box.ledger_is_closed ? "the box cannot read the ledger; wait, or run adit ledger new: "
                                     : "the box cannot write the ledger: ",
         .action = kOpenSystem});
  }
  if (scarce) find_scarce_disk(box, found);
  add(found, box.ledger_damage,
      {.id = "ledger_damaged", .severity = Severity::Ask, .headline = {"The ledger", "damaged"}});
  add(found, box.other_ledger,
      {.id = "other_ledger", .severity = Severity::Ask, .headline = {"An earlier ledger", "not read"}});
  add(found, box.put_aside,
      {.id = "queue_put_aside",
       .severity = Severity::Ask,
       .headline = {"Queued messages", "put aside", true}});
  add(found, box.disk.map, {.id = "map_not_kept", .headline = {"The last map", "not accepted"}});
  add(found, box.disk.state,
      {.id = "state_not_kept",
       .headline = {"States and markers", "rejected", true},
       .why = "the box cannot store them: "});
  if (!scarce) {
    add(found, box.disk.run,
        {.id = "run_not_kept",
         .headline = {"The run's map", "not stored"},
         .why = "a restart would lose it: "});
  }
  find_wear(box.disk, found);
}

void find_stamp_troubles(const facts::Box& box, Conditions& found) {
  constexpr double kDay = 86400;
  if (box.stamps_ahead > 0) {
    found.push_back({.id = "stamps",
                     .severity = Severity::Ask,
                     .side = Side::Box,
                     .headline = {"Time stamps", "ahead", true},
                     .why = sentence("by ", std::floor(box.stamps_ahead / kDay),
                                     " days; a factory reset sets them back")});
  } else {
    add(found, box.stamps_damage,
        {.id = "stamps", .severity = Severity::Ask, .headline = {"The last time stamps", "lost", true}});
  }
}

void find_update_troubles(const facts::Update& update, Conditions& found) {
  if (update.on_trial) {
    found.push_back({.id = "update_on_trial",
                     .severity = Severity::Wait,
                     .side = Side::Box,
                     .subject = update.version,
                     .headline = {"Version " + update.version, "on trial"},
                     .why = "keep the power on until the trial ends",
                     .action = kOpenSystem});
  }
  add(found, update.stray,
      {.id = "other_slot",
       .severity = Severity::Ask,
       .headline = {"An unexpected slot", "running"},
       .action = kOpenSystem});
}

}  // namespace

void find_network_troubles(const facts::Network& network, const Traffic& traffic, Conditions& found) {
  find_pending_change(network, found);
  find_cables(traffic, found);
  find_exchanged_cables(network, traffic, found);
  find_addresses(network, found);
}

void find_box_troubles(const facts::Box& box, Conditions& found) {
  add(found, box.standby,
      {.id = "standby",
       .headline = {"This box", "on standby"},
       .why = "it accepts and sends no data: ",
       .action = {"Open system", "/system#spare"}});
  find_disk_troubles(box, found);
  if (!box.time_set.value_or(true)) {
    found.push_back({.id = "time_not_set",
                     .severity = Severity::Wait,
                     .side = Side::Box,
                     .headline = {"The time of day", "not set"},
                     .why = "log in to the page, or run adit clock set",
                     .action = kOpenSystem});
  }
  find_stamp_troubles(box, found);
  add(found, box.ntp_trouble,
      {.id = "ntp",
       .severity = Severity::Wait,
       .headline = {"NTP", "not working"},
       .action = {"Open set-up", "/setup?setting=clock.ntp_server#all"}});
  add(found, box.change_trouble,
      {.id = "settings_not_changed", .headline = {"The last change", "not used"}, .action = kOpenSetUp});
  add(found, box.settings_trouble,
      {.id = "settings_not_used",
       .headline = {"The saved settings", "not used", true},
       .action = kOpenSetUp});
  add(found, box.board_trouble, {.id = "board_not_used", .headline = {"The board file", "not used"}});
  add(found, box.lights_trouble,
      {.id = "lights_not_set",
       .headline = {"The lights", "unreliable", true},
       .why = "the box cannot set them: "});
  for (const auto& [name, why] : box.notices)
    add(found, why, {.id = "notice:" + name, .subject = name, .headline = {"The box", "not healthy"}});
  find_update_troubles(box.update, found);
}

}  // namespace adit::alarms
