#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"

namespace adit::intake {

/// A received answer. Field names are in lower case.
struct Reply {
  int status = 0;
  std::map<std::string, std::string> headers;
  std::string body;

  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

/// A client on a blocking socket that sends given bytes. Its timeouts are shorter than the server's default
/// for a body, so an answer in time is not caused by that deadline. ADIT_PATIENCE multiplies its timeouts and
/// the deadlines of a Served.
class RawClient {
 public:
  /// `source`: an address of 127.0.0.0/8.
  explicit RawClient(std::uint16_t port, const std::string& source = "127.0.0.1");

  bool connected() const { return connected_; }
  /// Sends a small write only when the one before is acknowledged (Nagle's algorithm), as most libraries do.
  void delay_small_writes();
  /// False if the server has closed or reset the connection.
  bool send(std::string_view bytes);
  /// Returns the bytes sent until the socket accepted none for `patience`.
  std::size_t send_until_stalled(std::string_view bytes, std::chrono::milliseconds patience);
  /// The next answer; nothing if the connection ends or `patience` passes first.
  std::optional<Reply> reply(std::chrono::milliseconds patience = std::chrono::seconds(10),
                             bool to_head = false);
  /// Reads until `text` has come.
  bool wait_for(std::string_view text, std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// Reads `step` bytes and calls `between`, until `size` bytes of an answer's body have arrived or the
  /// connection ends. Returns the bytes of the body.
  std::size_t read_slowly(std::size_t step, std::size_t size, const std::function<void()>& between);
  /// All bytes until the server ends the connection; nothing if it does not within `patience`.
  std::optional<std::string> rest(std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// True if the server ends the connection.
  bool closes() { return rest().has_value(); }

  /// Ends only the sending direction.
  void half_close();
  /// Closes with a reset.
  void reset();
  void close() { fd_ = {}; }

 private:
  enum class Got { Bytes, End, Nothing };
  Got receive(std::chrono::steady_clock::time_point until);

  loop::FileDescriptor fd_;
  bool connected_ = false;
  std::string received_;
};

/// An HTTP/1.1 request with Host, `headers` ("Name: value\r\n" each), and Content-Length if it has a body.
std::string request(std::string_view method, std::string_view path, std::string_view headers = {},
                    std::string_view body = {});

}  // namespace adit::intake
