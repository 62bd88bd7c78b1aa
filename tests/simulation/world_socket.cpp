// Implements uplink/socket.hpp in the simulated world.
#include <cerrno>
#include <cstring>

#include "simulation/box.hpp"
#include "simulation/world.hpp"
#include "uplink/socket.hpp"

namespace adit::uplink {
namespace {

using simulation::Link;
using simulation::World;

Link* link_of(int fd) {
  World& world = World::current();
  world.crossing();
  return world.is_dead() ? nullptr : world.network().find(fd);
}

}  // namespace

std::expected<loop::FileDescriptor, NoSocket> begin_connect(const Endpoint& endpoint) {
  World& world = World::current();
  world.crossing();
  if (world.is_dead()) return std::unexpected(NoSocket{"dead", ENETDOWN});
  if (endpoint.interface != simulation::Box::kInterface) {
    world.note({.kind = simulation::Kind::Forbidden,
                .what = simulation::kConnect,
                .who = "",
                .text = "bound to '" + endpoint.interface + "'"});
  }
  return loop::FileDescriptor(world.network().connect(endpoint));
}

std::expected<std::size_t, int> write(int fd, std::span<const iovec> pieces) {
  Link* const link = link_of(fd);
  if (link == nullptr || link->reset) return std::unexpected(ECONNRESET);
  std::string bytes;
  for (const iovec& piece : pieces) bytes.append(static_cast<const char*>(piece.iov_base), piece.iov_len);
  const std::size_t taken = link->write(bytes);
  if (taken == 0) return std::unexpected(EAGAIN);
  link->view.left(std::string_view(bytes).substr(0, taken));
  World::current().crossing();
  return taken;
}

std::expected<std::size_t, int> write_evenly(int fd, std::span<const iovec> pieces, std::uint64_t) {
  return write(fd, pieces);
}

std::expected<std::size_t, int> read(int fd, std::span<char> bytes) {
  Link* const link = link_of(fd);
  if (link == nullptr) return std::unexpected(ECONNRESET);
  if (!link->inbox.empty()) {
    const std::size_t size = std::min(bytes.size(), link->inbox.size());
    std::memcpy(bytes.data(), link->inbox.data(), size);
    if (!link->is_deaf()) link->view.came(std::string_view(link->inbox).substr(0, size));
    link->inbox.erase(0, size);
    return size;
  }
  if (link->reset) return std::unexpected(ECONNRESET);
  if (link->ended) return 0;
  return std::unexpected(EAGAIN);
}

int connect_error(int fd) {
  const Link* const link = link_of(fd);
  if (link == nullptr) return ECONNRESET;
  if (link->error == 0)
    World::current().note({.kind = simulation::Kind::Opens, .what = simulation::kConnection, .who = ""});
  return link->error;
}

/// Recorded only; the simulated line has its own rate.
void set_pace(int fd, std::uint64_t bytes_per_second) {
  if (link_of(fd) == nullptr) return;
  World& world = World::current();
  world.note({.kind = simulation::Kind::Given,
              .what = simulation::kConnection,
              .who = "",
              .serial = static_cast<std::int64_t>(bytes_per_second),
              .stamp = world.network().map_rate()});
}

/// No effect: the exchange itself checks for unacknowledged bytes, with the same timeout.
void give_up_after(int, std::chrono::milliseconds) {}

void reset_on_close(int fd, bool reset) {
  if (Link* const link = link_of(fd)) link->resets_on_close = reset;
}

bool is_quiet(int fd) {
  const Link* const link = link_of(fd);
  return link != nullptr && link->inbox.empty() && !link->ended && !link->reset;
}

Transmission transmission(int fd) {
  const Link* const link = link_of(fd);
  if (link == nullptr) return {};
  return {.since_last_byte = World::current().now() - link->last_left(),
          .sent_twice = 0,
          .delivered = link->delivered(),
          .in_flight = link->unacknowledged(),
          .round_trip = link->round_trip(),
          .least_round_trip = link->least_round_trip()};
}

std::size_t unacknowledged_bytes(int fd) {
  const Link* const link = link_of(fd);
  return link == nullptr ? 0 : link->unacknowledged();
}

}  // namespace adit::uplink
