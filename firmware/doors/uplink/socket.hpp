#pragma once

#include <sys/uio.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <span>
#include <string>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::uplink {

struct Endpoint {
  std::string address;  // IPv4 or IPv6, numeric
  std::uint16_t port = 0;
  std::string interface;               // SO_BINDTODEVICE; "": not bound
  std::uint64_t bytes_per_second = 0;  // the highest rate; lower if the link delivers less; 0: not paced
  std::chrono::milliseconds connect_within{3000};
};

/// "10.100.1.200:8000" or "[fd00::1]:8000", for the Host header (RFC 9110 7.2) and messages.
std::string authority_of(const Endpoint& endpoint);

struct NoSocket {
  std::string why;
  int error = 0;  // an errno; 0: the address is not an IP address
};

/// Returns a non-blocking TCP socket with the endpoint's options that has begun to connect. The error says
/// what failed: "Connection refused", "binding to interface darpa0: No such device".
std::expected<loop::FileDescriptor, NoSocket> begin_connect(const Endpoint& endpoint);

/// Writes as many bytes of `pieces` as the kernel accepts at once. Returns their number or an errno (EAGAIN:
/// no room now).
std::expected<std::size_t, int> write(int fd, std::span<const iovec> pieces);

/// As write(), but the kernel sends at the socket's pace (SO_MAX_PACING_RATE) at most two full segments at
/// once, or what a faster pace of `bytes_per_second` sends within 0.2 ms. Otherwise it sends up to 64 KB at
/// once if the round trip is short (net.ipv4.tcp_tso_rtt_log), and a report on the same link waits 5 ms
/// behind them at 100 Mbit/s.
std::expected<std::size_t, int> write_evenly(int fd, std::span<const iovec> pieces,
                                             std::uint64_t bytes_per_second);

/// Returns the number of bytes read, 0 after the peer closed its direction, or an errno (EAGAIN: none yet).
std::expected<std::size_t, int> read(int fd, std::span<char> bytes);

/// The result of connecting: 0 or an errno.
int connect_error(int fd);

/// Sets TCP_USER_TIMEOUT: how long the peer may leave bytes unacknowledged.
void give_up_after(int fd, std::chrono::milliseconds silence);

/// Sets SO_LINGER. True: when the socket is closed, even by the end of this process, the kernel discards
/// unsent bytes and resets the connection. False: the kernel sends the rest.
void reset_on_close(int fd, bool reset);

/// True if an idle connection is open and has received no bytes.
bool is_quiet(int fd);

/// How bytes leave, according to the kernel (TCP_INFO).
struct Transmission {
  loop::Duration since_last_byte{};  // at least this long ago, also for bytes sent twice
  std::uint64_t sent_twice = 0;      // segments of this connection so far
  std::uint64_t delivered = 0;       // bytes of this connection so far, in whole segments
  std::size_t unsent = 0;            // bytes that the kernel holds and has not sent yet
  std::size_t in_flight = 0;         // bytes sent and not acknowledged, in whole segments
  loop::Duration round_trip{}, least_round_trip{};
};
Transmission transmission(int fd);

/// Sets SO_MAX_PACING_RATE: bytes per second, > 0.
void set_pace(int fd, std::uint64_t bytes_per_second);

/// Unacknowledged bytes in the kernel; more than were sent if the kernel does not answer.
std::size_t unacknowledged_bytes(int fd);

}  // namespace adit::uplink
