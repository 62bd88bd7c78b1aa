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
#include "uplink/connection.hpp"

namespace adit::uplink {

/// "10.100.1.200:8000" or "[fd00::1]:8000": for the Host header (RFC 9110 7.2) and for sentences.
std::string authority_of(const Endpoint& endpoint);

struct NoSocket {
  std::string why;
  int error = 0;  // an errno; 0: the address is none
};

/// A non-blocking TCP socket of the endpoint's settings that has begun to connect, or why there is none:
/// "Connection refused", "binding to interface darpa0: No such device".
std::expected<loop::FileDescriptor, NoSocket> begin_connect(const Endpoint& endpoint);

/// Gives the kernel as much of `pieces` as it takes at once: how many bytes that were, or an errno (EAGAIN:
/// none now).
std::expected<std::size_t, int> write(int fd, std::span<const iovec> pieces);

/// The same, so that the kernel lets no more than two full segments leave at once, at the socket's pace in
/// between (SO_MAX_PACING_RATE): else it lets up to 64 KB leave, as one, where the round trip is short
/// (net.ipv4.tcp_tso_rtt_log), and a report on the same link waits 5 ms behind them at 100 Mbit/s.
std::expected<std::size_t, int> write_evenly(int fd, std::span<const iovec> pieces);

/// What has come: how many bytes, 0 once the peer has ended its direction, or an errno (EAGAIN: nothing yet).
std::expected<std::size_t, int> read(int fd, std::span<char> bytes);

/// How connecting ended: 0 or an errno.
int connect_error(int fd);

/// TCP_USER_TIMEOUT: how long bytes may stay without the peer's acknowledgement.
void give_up_after(int fd, std::chrono::milliseconds silence);

/// SO_LINGER: whether closing the socket, also by the death of this process, throws away what the peer has
/// not taken and resets the connection, in place of sending the rest of it from the kernel.
void reset_on_close(int fd, bool reset);

/// Whether an idle connection is still there: neither closed, nor has anything come that nobody asked for.
bool is_quiet(int fd);

/// How bytes leave, as the kernel says (TCP_INFO).
struct Transmission {
  loop::Duration since_last_byte{};  // at least so long ago the last one left, first or again
  std::uint64_t sent_twice = 0;      // segments of this connection so far
  std::uint64_t delivered = 0;       // bytes of this connection so far, about: whole segments
  std::size_t unsent = 0;            // bytes that the kernel holds and has not sent yet
  std::size_t in_flight = 0;         // bytes that it has sent and the peer has not acknowledged, about
  loop::Duration round_trip{}, least_round_trip{};
};
Transmission transmission(int fd);

/// SO_MAX_PACING_RATE, in bytes a second; > 0.
void set_pace(int fd, std::uint64_t bytes_per_second);

/// Bytes that the kernel holds and the peer has not acknowledged; if the kernel does not say, more than were
/// sent.
std::size_t unacknowledged_bytes(int fd);

}  // namespace adit::uplink
