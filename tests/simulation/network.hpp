#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "loop/loop.hpp"
#include "simulation/random.hpp"
#include "simulation/stalls.hpp"
#include "simulation/upstream_view.hpp"
#include "uplink/connection.hpp"

namespace adit::simulation {

class World;
class Link;

/// The Command Post's end of a connection.
class Peer {
 public:
  virtual ~Peer() = default;
  /// `left`: when Adit passed the bytes to the network.
  virtual void received(std::string_view bytes, loop::Instant left) = 0;
  /// Adit has closed the connection; no bytes follow.
  virtual void ended() = 0;
};

/// Accepts connections.
class Host {
 public:
  virtual ~Host() = default;
  /// The result of a connection attempt: 0, an errno, or nullopt for no answer.
  virtual std::optional<int> connecting(const uplink::Endpoint& endpoint) = 0;
  /// `link` outlives the peer.
  virtual std::unique_ptr<Peer> connected(const uplink::Endpoint& endpoint, Link& link) = 0;
};

/// One TCP connection to the Command Post, in memory: latency, windows, pieces of any size. In one of four
/// runs a map takes most of a second to arrive, so that the next map is sent before its answer.
class Link : public std::enable_shared_from_this<Link> {
 public:
  /// `number`: identifies the connection in the history (Event::request).
  Link(World& world, std::uint64_t number, uplink::Endpoint endpoint, Random random);

  // Adit's end.
  std::size_t write(std::string_view bytes);  // returns the bytes that fit into the window
  std::string inbox;
  UpstreamView view;                  // records the messages of this connection
  bool ended = false, reset = false;  // what Adit finds at the end of its inbox
  bool open = false;
  int error = 0;  // of the connection attempt
  bool resets_on_close = false;
  std::size_t unacknowledged() const { return unacknowledged_; }
  std::uint64_t delivered() const { return delivered_; }  // bytes acknowledged by the other end
  loop::Duration round_trip() const { return round_trip_; }
  loop::Duration least_round_trip() const { return least_round_trip_; }
  loop::Instant last_left() const { return last_left_; }  // when write() last accepted bytes
  std::uint32_t ready() const;
  void close();
  /// The power of Adit's machine is cut: sent bytes arrive, and the other end sees no close.
  void vanish();
  bool has_vanished() const { return vanished_; }
  void connect(Host& host);

  // The Command Post's end.
  /// Sends bytes to Adit. They arrive in the order of the calls.
  void send(std::string bytes, loop::Duration delay = {});
  enum class How : std::uint8_t { End, Reset };
  void end(How how, loop::Duration delay = {});
  /// From now on Adit's bytes neither arrive nor are acknowledged.
  void go_deaf() { deaf_ = true; }
  bool is_deaf() const { return deaf_; }
  /// When the last bytes that were sent leave.
  loop::Instant answers_until() const { return answers_until_; }
  std::uint64_t number() const { return number_; }
  const uplink::Endpoint& endpoint() const { return endpoint_; }
  bool is_closed() const { return closed_; }

 private:
  loop::Duration latency();
  loop::Instant arrival();
  loop::Instant arrival_of(std::size_t bytes);
  void acknowledge(std::size_t bytes, loop::Instant left_at);

  World& world_;
  const std::uint64_t number_;
  const uplink::Endpoint endpoint_;
  Random random_;
  double typical_;        // latency in seconds
  bool is_thin_ = false;  // a map is in flight, and maps take long here
  std::size_t window_;
  std::size_t unacknowledged_ = 0;
  const bool acknowledges_late_;  // acknowledges the last bytes late
  std::uint64_t delivered_ = 0;
  loop::Duration round_trip_{}, least_round_trip_{};
  bool closed_ = false, lost_ = false, deaf_ = false, vanished_ = false;
  loop::Instant last_there_{}, last_here_{}, last_left_{}, held_until_{}, answers_until_{};
  std::unique_ptr<Peer> peer_;
};

/// Adit's connections to the Command Post, by simulated descriptors.
class Network {
 public:
  static constexpr int kFirst = 1 << 20;
  static bool is_simulated(int fd) { return fd >= kFirst; }

  explicit Network(World& world);
  void serve(Host* host) { host_ = host; }
  Stalls& stalls() { return stalls_; }
  /// Bytes per second of a map; 0: no limit.
  double map_rate() const { return map_rate_; }

  /// Returns a descriptor.
  int connect(const uplink::Endpoint& endpoint);
  Link* find(int fd);
  void close(int fd);
  /// The process has ended: the kernel closes its connections.
  void cut();
  /// The machine's power is cut.
  void vanish();

  using Ready = std::function<void(std::uint32_t)>;
  std::uint64_t watch(int fd, std::uint32_t events, Ready ready);
  void wait_for(std::uint64_t number, std::uint32_t events);
  void unwatch(std::uint64_t number) { watched_.erase(number); }
  bool dispatch();

 private:
  struct Watched {
    int fd;
    std::uint32_t events;
    Ready ready;
  };
  World& world_;
  Stalls stalls_;
  double map_rate_;
  Host* host_ = nullptr;
  int last_fd_ = kFirst;
  std::uint64_t last_ = 0;
  std::map<int, std::shared_ptr<Link>> links_;
  std::vector<std::shared_ptr<Link>> vanished_;
  std::map<std::uint64_t, Watched> watched_;
};

}  // namespace adit::simulation
