/// adit-network: changes the box's addresses and the firewall's open ports, for unprivileged aditd.

#include <net/if.h>
#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <expected>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "applier/applier.hpp"
#include "applier/arp.hpp"
#include "applier/conflict_detector.hpp"
#include "applier/options.hpp"
#include "applier/team_ports.hpp"
#include "command_line/read.hpp"
#include "host/interfaces.hpp"
#include "host/log.hpp"
#include "host/root_program.hpp"
#include "host/service.hpp"
#include "host/systemd.hpp"
#include "icd/try.hpp"
#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"
#include "loop/watchdog.hpp"
#include "network/messages.hpp"

namespace adit::applier {
namespace {

/// Listens for address conflicts on the box's two interfaces and for the Command Post at the team's port, and
/// writes them to network::kTakenFile. Runs until the box stops. Interfaces may come and go.
class AddressWatch {
 public:
  /// Packets read at once, and the pause then. In a flood the kernel drops packets, at no CPU time here.
  static constexpr int kMostAtOnce = 64;
  static constexpr std::chrono::milliseconds kRest{100};
  /// Least time between two writes of the file, and between two log lines about an interface.
  static constexpr std::chrono::seconds kBetweenTellings{1}, kBetweenLines{60};
  static constexpr std::chrono::seconds kLookAgain{10};  // after an error

  /// Both must outlive this object.
  AddressWatch(loop::Loop& loop, const Options& options);

  /// Error: the watch cannot hear packets or write the file.
  std::expected<void, std::string> start();

 private:
  using Instant = ConflictDetector::Instant;

  struct Side {
    std::string interface;
    unsigned index = 0;  // of the interface listened on; 0: not listening
    bool carrier = false;
    std::string trouble = {};  // why it cannot listen, or ""
    ConflictDetector takers = {};
    std::optional<Instant> rests_until = {};
    std::optional<Instant> said_at = {};   // last log line
    std::vector<std::uint32_t> said = {};  // addresses logged as in conflict
    std::optional<ArpSocket> arp = {};
    loop::Source heard = {};  // destroyed before its descriptor is closed
  };

  Side& team() { return sides_.front(); }
  Side& post() { return sides_.back(); }
  /// Reads addresses and interfaces. After an error, watches the last known addresses and tries again.
  void refresh();
  std::expected<void, std::string> read_addresses();
  void refresh(Side& side, const std::vector<settings::Subnet>& own, const std::vector<Mac>& macs,
               const std::vector<std::uint32_t>& sought);
  void open(Side& side, unsigned index);
  void read_packets(Side& side);
  void work();
  static void ask(const Side& side, const std::vector<std::uint32_t>& addresses);
  static void log_conflicts(Side& side, Instant now);
  void write_status(Instant now);
  network::AddressConflicts conflicts(Instant now) const;

  loop::Loop& loop_;
  std::array<Side, 2> sides_;
  SwappedCables exchanged_;
  StatusReader told_;
  host::StatusFile file_;
  std::optional<Instant> written_at_;
  const loop::FileDescriptor kernel_;
  loop::Source changed_, due_, again_;
};

using host::Level;

static_assert(2 * ConflictDetector::kMost <= network::kMostTaken);

/// The addresses to watch.
std::vector<std::uint32_t> addresses_of(const std::vector<settings::Subnet>& own) {
  std::vector<std::uint32_t> all;
  all.reserve(own.size());
  for (const settings::Subnet& each : own) all.push_back(each.address);
  all.resize(std::min(all.size(), ConflictDetector::kMost));
  return all;
}

network::AddressConflict row_of(const std::string& interface, const ConflictDetector::Conflict& taken) {
  return {.interface = interface,
          .address = settings::ipv4_text(taken.address),
          .mac = text_of(taken.by),
          .seen = taken.seen};
}

AddressWatch::AddressWatch(loop::Loop& loop, const Options& options)
    : loop_(loop),
      sides_{{{.interface = options.team}, {.interface = options.command_post}}},
      told_(loop, options.told, [this] { refresh(); }),
      file_(options.status + '/' + network::kTakenFile),
      kernel_(host::link_and_address_changes()),
      due_(loop.timer([this] { work(); })),
      again_(loop.timer([this] { refresh(); })) {}

std::expected<void, std::string> AddressWatch::start() {
  if (!kernel_) return std::unexpected("cannot watch the interfaces for changes");
  changed_ = loop_.watch(kernel_.get(), EPOLLIN, [this](std::uint32_t) {
    if (!host::take_link_changes(kernel_)) changed_.wait_for(0);
    refresh();
  });
  (void)ADIT_TRY(file_.write(network::AddressConflicts{}));
  refresh();
  return {};
}

void AddressWatch::refresh() {
  if (!host::log_failure(Level::Error, "cannot look for address conflicts", read_addresses()))
    again_.call_at(loop_.now() + kLookAgain);
  work();
}

std::expected<void, std::string> AddressWatch::read_addresses() {
  const auto at_team = ADIT_TRY(host::own_addresses(team().interface));
  const auto at_post = ADIT_TRY(host::own_addresses(post().interface));
  std::vector<Mac> macs;
  for (const Side& side : sides_) {
    if (const auto mac = mac_of(side.interface)) macs.push_back(*mac);
  }
  const auto sought = sought_in(told_.read(), at_post, at_team);
  exchanged_.set_sought(sought, macs, loop_.now());
  refresh(team(), at_team, macs, sought);
  refresh(post(), at_post, macs, sought);
  return {};
}

void AddressWatch::refresh(Side& side, const std::vector<settings::Subnet>& own, const std::vector<Mac>& macs,
                           const std::vector<std::uint32_t>& sought) {
  const Instant now = loop_.now();
  const unsigned index = if_nametoindex(side.interface.c_str());
  const bool is_ours = side.arp && std::ranges::find(macs, side.arp->own()) != macs.end();
  if (index != side.index || !is_ours) open(side, index);
  auto addresses = addresses_of(own);
  side.takers.set_own(addresses, macs, now);
  addresses.insert(addresses.end(), sought.begin(), sought.end());
  if (side.arp) {
    // read_packets() checks each packet anyway, so a missing filter only costs time.
    host::log_failure(Level::Warning, "cannot filter ARP: reading all of it",
                      side.arp->filter_addresses(addresses));
  }
  const bool had_carrier = std::exchange(side.carrier, host::carrier(side.interface).value_or(false));
  if (!side.carrier || had_carrier) return;
  side.takers.restart_probing(now);
  if (&side == &team()) exchanged_.restart_probing(now);
}

void AddressWatch::open(Side& side, unsigned index) {
  side.heard = {};
  side.arp.reset();
  side.index = 0;
  if (index == 0) return;
  auto arp = ArpSocket::open(side.interface);
  if (!arp) {
    if (side.trouble != arp.error()) host::log(Level::Error, "cannot listen to ARP", {{"why", arp.error()}});
    side.trouble = std::move(arp.error());
    return;
  }
  side.trouble.clear();
  side.index = index;
  side.arp = std::move(*arp);
  side.rests_until.reset();
  side.heard =
      loop_.watch(side.arp->descriptor(), EPOLLIN, [this, &side](std::uint32_t) { read_packets(side); });
}

void AddressWatch::read_packets(Side& side) {
  const Instant now = loop_.now();
  std::uint8_t packet[128];
  for (int i = 0; i < kMostAtOnce; ++i) {
    const auto size = side.arp->receive(packet);
    if (!size) return work();
    const auto arp = read_arp({packet, *size});
    if (!arp) continue;
    side.takers.on_packet(*arp, now);
    if (&side == &team()) exchanged_.on_team_packet(*arp, now);
    if (&side == &post()) exchanged_.on_command_post_packet(*arp, now);
  }
  side.rests_until = now + kRest;
  side.heard.wait_for(0);
  work();
}

void AddressWatch::work() {
  const Instant now = loop_.now();
  for (Side& side : sides_) {
    if (side.rests_until && now >= *side.rests_until) {
      side.rests_until.reset();
      side.heard.wait_for(EPOLLIN);
    }
    ask(side, side.takers.pop_due(now));
    log_conflicts(side, now);
  }
  const SwappedCables::DueProbes due = exchanged_.pop_due(now);
  ask(team(), due.at_team);
  ask(post(), due.at_post);
  std::optional<Instant> next;
  const auto at = [&next](const std::optional<Instant>& when) {
    if (when) next = std::min(*when, next.value_or(*when));
  };
  write_status(now);
  if (written_at_) at(*written_at_ + kBetweenTellings);
  at(exchanged_.wake());
  for (const Side& side : sides_) {
    at(side.takers.wake());
    at(side.rests_until);
  }
  due_.cancel();
  if (next) due_.call_at(*next);
}

void AddressWatch::ask(const Side& side, const std::vector<std::uint32_t>& addresses) {
  for (const std::uint32_t address : addresses) {
    if (!side.arp || !side.carrier) continue;  // refresh() asks again after the carrier returns
    host::log_failure(Level::Debug, "cannot send an ARP request", side.arp->ask(address));
  }
}

/// Logs conflicts at most once per kBetweenLines, so that a machine cannot fill the log by coming and going.
void AddressWatch::log_conflicts(Side& side, Instant now) {
  const auto taken = side.takers.conflicts();
  const auto is_taken = [&taken](std::uint32_t address) {
    return std::ranges::find(taken, address, &ConflictDetector::Conflict::address) != taken.end();
  };
  if (!side.said.empty() && std::ranges::none_of(side.said, is_taken)) {
    side.said.clear();
    host::log(Level::Notice, "no other machine uses the box's address any more",
              {{"interface", side.interface}});
  }
  if (taken.empty() || !side.said.empty() || (side.said_at && now < *side.said_at + kBetweenLines)) return;
  side.said_at = now;
  for (const ConflictDetector::Conflict& each : taken) side.said.push_back(each.address);
  host::log(Level::Warning, "another machine uses the box's address",
            {{"interface", side.interface},
             {"address", settings::ipv4_text(taken.front().address)},
             {"mac", text_of(taken.front().by)}});
}

void AddressWatch::write_status(Instant now) {
  if (written_at_ && now < *written_at_ + kBetweenTellings) return;
  written_at_.reset();
  const auto is_written = file_.write(conflicts(now));
  if (!is_written || *is_written) written_at_ = now;
}

network::AddressConflicts AddressWatch::conflicts(Instant now) const {
  network::AddressConflicts all;
  for (const Side& side : sides_) {
    for (const ConflictDetector::Conflict& each : side.takers.conflicts())
      all.addresses.push_back(row_of(side.interface, each));
  }
  for (const ConflictDetector::Conflict& each : exchanged_.conflicts(now))
    all.exchanged.push_back(row_of(sides_.front().interface, each));
  return all;
}

}  // namespace
}  // namespace adit::applier

namespace {

bool log_if_failed(const std::expected<void, std::string>& done) {
  return adit::host::log_failure(adit::host::Level::Error, "cannot run", done);
}

/// Runs until the box stops.
int watch(const adit::applier::Options& options) {
  adit::loop::Loop loop;
  adit::applier::AddressWatch watch(loop, options);
  const auto terminated = loop.signal(SIGTERM, [&loop] { loop.stop(); });
  const auto interrupted = loop.signal(SIGINT, [&loop] { loop.stop(); });
  if (!log_if_failed(watch.start())) return 1;
  std::optional<adit::loop::Watchdog> watchdog;
  if (const auto within = adit::host::watchdog_interval())
    watchdog.emplace(loop, *within, &adit::host::notify_alive);
  adit::host::notify_ready("listening");
  loop.run();
  return 0;
}

int run(const adit::applier::Options& options) {
  adit::loop::Loop loop;
  adit::applier::Applier applier(loop, options);
  const auto terminated = loop.signal(SIGTERM, [&applier] { applier.stop(); });
  const auto interrupted = loop.signal(SIGINT, [&applier] { applier.stop(); });
  if (!log_if_failed(applier.start())) return 1;
  loop.run();
  return applier.is_done() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  using adit::applier::command_line_of;
  const auto options = adit::applier::parse_options({argv + 1, argv + argc});
  if (const auto exit =
          adit::command_line::answer<adit::applier::Options>(command_line_of, ADIT_VERSION, options))
    return *exit;
  if (options->watch) return watch(*options);
  if (options->ports) return log_if_failed(adit::applier::write_port_rules(*options)) ? 0 : 1;
  if (!options->start) return run(*options);
  // Once at boot, before networkd.
  return log_if_failed(adit::applier::NetworkdFiles(*options).write_at_start()) ? 0 : 1;
}
