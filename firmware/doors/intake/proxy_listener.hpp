#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <expected>
#include <functional>
#include <list>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"
#include "loop/loop.hpp"

namespace adit::intake {

/// The first line of a connection that a program of this machine passes on. It names the two ends of the
/// connection that the program accepted (PROXY protocol, version 1).
struct ProxyHeader {
  static constexpr std::size_t kMostBytes = 107;  // with CRLF
  enum class Missing : std::uint8_t { More, Refused };

  std::size_t size = 0;  // bytes, with CRLF
  std::string peer;      // "10.0.0.5"
  std::string local;     // the box's address that the client used: "10.0.0.1"

  /// The header at the start of `bytes`. More: it may become whole. Refused: it cannot, or it has no
  /// addresses ("UNKNOWN").
  static std::expected<ProxyHeader, Missing> parse(std::string_view bytes);
};

/// Accepts connections and reads the header of each. Closes a connection with another beginning, one whose
/// header is not whole within a time, and the oldest one of more than kMostWaiting that wait for a header.
class ProxyListener {
 public:
  static constexpr std::size_t kMostWaiting = 32;
  /// The next byte of the connection is the one after its header.
  using Admit = std::function<void(loop::FileDescriptor connection, ProxyHeader header)>;

  /// `listening` must not block.
  ProxyListener(loop::Loop& loop, loop::FileDescriptor listening, std::chrono::milliseconds within,
                Admit admit);

 private:
  struct PendingConnection {
    loop::FileDescriptor connection;
    loop::Instant until;
    loop::Source arrivals;
  };

  void accept_some();
  void read_header(std::list<PendingConnection>::iterator waiting);
  void close_late();

  loop::Loop& loop_;
  const std::chrono::milliseconds within_;
  const Admit admit_;
  loop::FileDescriptor listening_;
  std::list<PendingConnection> waiting_;  // the oldest first
  loop::Source connects_, late_;
};

}  // namespace adit::intake
