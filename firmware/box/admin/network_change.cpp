#include "admin/network_change.hpp"

#include <algorithm>

#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::admin {
namespace {

/// Resolves names on the team's side alone, as mDNS listens only there. Error: the interfaces cannot be read.
std::expected<api::PortRow, std::string> port_of(const char* side, const std::string& interface) {
  const auto all = ADIT_TRY(host::interfaces());
  const auto found = std::ranges::find(all, interface, &host::Interface::name);
  const host::Port port = ADIT_TRY(host::port(interface)).value_or(host::Port{});
  const bool is_team = std::string_view(side) == "team";
  api::PortRow row{.side = side,
                   .interface = interface,
                   .mac = port.mac,
                   .addresses = {},
                   .name = {},
                   .carrier = {},
                   .mbit = port.mbit,
                   .duplex = port.duplex};
  if (found == all.end()) return row;
  row.addresses = found->addresses;
  row.carrier = found->carrier;
  if (is_team) row.name = host::local_name();
  return row;
}

}  // namespace

void NetworkChange::read_taken() const {
  const loop::Instant now = loop_.now();
  if (taken_read_at_ && now < *taken_read_at_ + host::kFresh) return;
  taken_read_at_ = now;
  auto read = host::read_row<network::AddressConflicts>(taken_file_);
  if (read) taken_ = std::move(*read).value_or(network::AddressConflicts{});
  const std::string trouble = read ? "" : std::move(read.error());
  if (std::exchange(taken_trouble_, trouble) != trouble && !trouble.empty())
    host::log(host::Level::Error, "cannot read which addresses another machine uses", {{"why", trouble}});
}

void NetworkChange::every_second() {
  adit_network_.check();
  lead_to_endpoints();
}

std::string NetworkChange::refusal_reason() const {
  const std::string& team = settings_.team.interface;
  const std::string& post = settings_.command_post.interface;
  if (team.empty() || post.empty()) {
    return icd::sentence("the settings name no ", team.empty() ? "team.interface" : "command_post.interface");
  }
  const auto status = adit_network_.status();
  if (!status) return adit_network_.status_error();
  if (!status->trouble.empty()) return "adit-network cannot work: " + status->trouble;
  if (status->team_interface != team || status->command_post_interface != post) {
    return icd::sentence("adit-network has ", status->team_interface, " and ", status->command_post_interface,
                         ", but the settings name ", team, " and ", post);
  }
  return "";
}

std::optional<network::Pending> NetworkChange::pending() const {
  const auto status = adit_network_.status();
  if (status && status->pending) return status->pending;
  if (!adit_network_.is_pending()) return std::nullopt;
  return network::Pending{wanted_.nonce, wanted_.numbers, wanted_at_ + wanted_.confirm_within,
                          wanted_.confirm_within};
}

std::optional<network::Numbers> NetworkChange::confirmed_numbers() const {
  const auto status = adit_network_.status();
  return status ? status->kept : std::nullopt;
}

std::expected<std::optional<network::Numbers>, std::string> NetworkChange::present() const {
  if (auto kept = this->confirmed_numbers()) return kept;
  const auto team = ADIT_TRY(host::own_address(settings_.team.interface));
  if (!team) return std::nullopt;
  auto post = ADIT_TRY(host::own_addresses(settings_.command_post.interface));
  return network::Numbers{.team = *team, .command_post = std::move(post)};
}

api::NetworkView NetworkChange::state() const {
  api::NetworkView view;
  view.now = loop_.wall_now();
  view.why = refusal_reason();
  view.runs_here = adit_network_.runs_here();
  view.team_interface = settings_.team.interface;
  view.command_post_interface = settings_.command_post.interface;
  const auto team = host::own_address(view.team_interface);
  auto post = host::own_addresses(view.command_post_interface);
  if (!team) view.why = team.error();
  if (!post) view.why = post.error();
  for (const auto& [side, interface] :
       {std::pair("team", view.team_interface), std::pair("command_post", view.command_post_interface)}) {
    if (interface.empty()) continue;
    if (auto port = port_of(side, interface)) {
      view.ports.push_back(*std::move(port));
    } else {
      view.why = port.error();
    }
  }
  view.managed = view.why.empty();
  view.team = team.value_or(std::nullopt);
  view.command_post = std::move(post).value_or(std::vector<settings::Subnet>());
  const auto kept = this->confirmed_numbers();
  if (kept) {
    view.mode = kept->mode;
    view.gateway = kept->gateway;
  }
  if (const auto waits = pending()) {
    const double left = std::chrono::duration<double>(waits->until - loop_.now()).count();
    view.pending = {
        .until = view.now + left, .wanted = waits->wanted, .previous = kept, .page = page_at(waits->wanted)};
  }
  if (view.pending) return view;  // the previous change's end says nothing about this one
  view.last_why = adit_network_.trouble();
  const auto status = adit_network_.status();
  if (!view.last_why.empty()) {
    view.last = name_of(network::ChangeOutcome::Reverted);
  } else if (status) {
    view.last = name_of(status->ended);
    view.last_why = status->why;
  }
  return view;
}

network::Findings NetworkChange::check(const network::Numbers& wanted, const std::string& asker) const {
  const auto present = this->present();
  if (!present) return {.errors = {{"", present.error()}}, .changes = {}, .warnings = {}};
  return network::check(wanted, *present,
                        {.allow_overlap = settings_.network.allow_overlap,
                         .confirm_within = settings_.network.confirm_within,
                         .command_post = settings_.command_post,
                         .courses = settings_.courses,
                         .listen = settings_.team.listen,
                         .asker = asker,
                         .name = host::local_name()});
}

icd::Checked<void> NetworkChange::change(const network::Numbers& wanted) {
  if (pending()) return icd::conflict("another change is not yet confirmed or reverted");
  if (!adit_network_.status()) return adit_network_.refuse();
  if (const std::string why = refusal_reason(); !why.empty()) return icd::conflict(why);
  wanted_ = {host::draw_nonce(), settings_.network.confirm_within, wanted};
  wanted_at_ = loop_.now();
  if (const auto asked = adit_network_.ask(network::kWantedFile, wanted_); !asked)
    return icd::conflict("cannot request the change: " + asked.error());
  host::log(host::Level::Notice, "change of the addresses requested",
            {{"team", network::team_text(wanted)}, {"command_post", network::command_post_text(wanted)}});
  return {};
}

icd::Checked<void> NetworkChange::confirm(const std::string& local) {
  const auto waits = pending();
  if (!waits) return icd::conflict("there is no change to confirm");
  if (auto may = check_confirmable(waits->wanted, local); !may) return may;
  return send_decision(network::Decision::Command::Confirm, *waits);
}

/// An address from DHCP or a link-local one is not known in advance, so any but the old one confirms it.
icd::Checked<void> NetworkChange::check_confirmable(const network::Numbers& wanted,
                                                    const std::string& local) const {
  const bool fixed = wanted.mode == network::Mode::Static;
  const auto kept = this->confirmed_numbers();
  const bool stays = kept && kept->mode == wanted.mode && kept->team.address == wanted.team.address;
  if ((stays || !fixed) && adit_network_.is_pending())
    return icd::conflict("the change is not applied yet: try again in a few seconds");
  const bool new_one = fixed ? local == settings::ipv4_text(wanted.team.address)
                             : !kept || local != settings::ipv4_text(kept->team.address);
  if (stays || new_one) return {};
  return icd::conflict("confirm it at ", page_at(wanted), ": this request came to ", local,
                       " and does not show that the new address works");
}

void NetworkChange::lead_to_endpoints() {
  if (!refusal_reason().empty()) return;
  network::Endpoints all;
  const auto add = [&all](const settings::Address& address) {
    if (const auto number = settings::ipv4_of(address.address)) all.addresses.push_back(*number);
  };
  add(settings_.command_post.scoring);
  add(settings_.command_post.mapping);
  for (const settings::Course& course : settings_.courses) {
    add(course.scoring);
    add(course.mapping);
  }
  std::ranges::sort(all.addresses);
  const auto twice = std::ranges::unique(all.addresses);
  all.addresses.erase(twice.begin(), twice.end());
  const auto status = adit_network_.status();
  if (!status || status->endpoints == all || (told_at_ && loop_.now() < *told_at_ + kTellAgain)) return;
  told_at_ = loop_.now();
  host::log_failure(host::Level::Error, "cannot tell adit-network the endpoints",
                    adit_network_.submit(network::kEndpointsFile, all));
}

std::expected<std::string, std::string> NetworkChange::next_hop(const settings::Address& endpoint) const {
  const auto number = settings::ipv4_of(endpoint.address);
  const auto numbers = ADIT_TRY(present());
  if (!number || !numbers) return "";
  const auto hop = network::next_hop(*numbers, *number);
  return hop ? settings::ipv4_text(*hop) : "";
}

std::expected<network::Probe, std::string> NetworkChange::probe(const std::string& interface,
                                                                const settings::Address& endpoint) const {
  const auto status = adit_network_.status();
  if (!status) return std::unexpected(adit_network_.status_error());
  if (status->command_post_interface != interface)
    return std::unexpected("adit-network has " + status->command_post_interface + " instead");
  const auto hop = ADIT_TRY(next_hop(endpoint));
  network::Probe probe{host::draw_nonce(), hop};
  ADIT_TRY(adit_network_.submit(network::kProbeFile, probe));
  return probe;
}

std::expected<std::optional<network::ProbeResult>, std::string> NetworkChange::answer_to(
    const network::Probe& probe) const {
  auto read = host::read_row<network::ProbeResult>(adit_network_.directory() + '/' + network::kProbedFile);
  if (read && *read && (*read)->nonce != probe.nonce) read->reset();
  return read;
}

icd::Checked<void> NetworkChange::revert() {
  const auto waits = pending();
  if (!waits) return icd::conflict("there is no change to revert");
  return send_decision(network::Decision::Command::Revert, *waits);
}

icd::Checked<void> NetworkChange::send_decision(network::Decision::Command what,
                                                const network::Pending& pending) const {
  if (const auto asked = adit_network_.submit(network::kWordFile, network::Decision{pending.nonce, what});
      !asked) {
    return icd::conflict("cannot tell adit-network: " + asked.error());
  }
  return {};
}

/// The interface's first conflict.
std::optional<facts::AddressConflict> NetworkChange::address_conflict(const std::string& interface,
                                                                      bool is_team) const {
  for (const network::AddressConflict& each : taken_.addresses) {
    if (each.interface != interface || loop_.now() >= each.seen + network::kTakenFor) continue;
    return facts::AddressConflict{
        .is_team = is_team, .interface = interface, .address = each.address, .mac = each.mac};
  }
  return std::nullopt;
}

/// The first one that is an endpoint of the settings or its gateway.
std::optional<facts::SwappedAddress> NetworkChange::swapped_address() const {
  const auto scoring = next_hop(settings_.command_post.scoring),
             mapping = next_hop(settings_.command_post.mapping);
  std::string trouble;
  if (!scoring) trouble = scoring.error();
  if (!mapping) trouble = mapping.error();
  if (std::exchange(hop_trouble_, trouble) != trouble && !trouble.empty())
    host::log(host::Level::Error, "cannot check at which port the Command Post is", {{"why", trouble}});
  for (const network::AddressConflict& each : taken_.exchanged) {
    if (loop_.now() >= each.seen + network::kTakenFor) continue;
    if (each.interface != settings_.team.interface || (each.address != scoring && each.address != mapping))
      continue;
    return facts::SwappedAddress{
        .address = each.address, .found_on = each.interface, .sought_on = settings_.command_post.interface};
  }
  return std::nullopt;
}

std::string NetworkChange::page_at(const network::Numbers& numbers) const {
  return network::page_at(numbers, settings_.team.listen, host::local_name());
}

facts::Network NetworkChange::fact() const {
  facts::Network fact;
  read_taken();
  const auto waits = pending();
  const auto kept = this->confirmed_numbers();
  const bool bare = kept && kept->command_post.empty();
  fact.no_address = !waits && bare && refusal_reason().empty();
  if (waits) {
    fact.confirm_within = std::chrono::duration<double>(waits->until - loop_.now()).count();
    fact.page = page_at(waits->wanted);
  }
  for (const bool is_team : {true, false}) {
    const std::string& interface = is_team ? settings_.team.interface : settings_.command_post.interface;
    if (auto taken = address_conflict(interface, is_team)) fact.taken.push_back(std::move(*taken));
  }
  if (!taken_.exchanged.empty()) fact.exchanged = swapped_address();
  return fact;
}

}  // namespace adit::admin
