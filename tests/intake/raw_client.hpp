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

/// An answer as it came over the wire. Field names in lower case.
struct Reply {
  int status = 0;
  std::map<std::string, std::string> headers;
  std::string body;

  std::string header(const std::string& name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? "" : found->second;
  }
};

/// A client that does just what it is told, byte by byte, over a blocking socket. Its patience is less than
/// that of a server, by default, for a body: what comes in time did not come by the server's own deadline.
/// ADIT_PATIENCE multiplies it, and the deadlines of a Served.
class RawClient {
 public:
  /// From `source`, which is any of 127.0.0.0/8.
  explicit RawClient(std::uint16_t port, const std::string& source = "127.0.0.1");

  bool connected() const { return connected_; }
  /// False where the server has closed or reset the connection.
  bool send(std::string_view bytes);
  /// How many of `bytes` went out before nothing more did for `patience`.
  std::size_t send_until_stalled(std::string_view bytes, std::chrono::milliseconds patience);
  /// The next answer, or nothing where the connection ends first or none comes in `patience`.
  std::optional<Reply> reply(std::chrono::milliseconds patience = std::chrono::seconds(10),
                             bool to_head = false);
  /// Reads until `text` has come.
  bool wait_for(std::string_view text, std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// Takes `step` bytes and calls `between`, until `size` of an answer's body have come or the
  /// connection ends; how many came.
  std::size_t read_slowly(std::size_t step, std::size_t size, const std::function<void()>& between);
  /// All bytes until the server ends the connection; nothing where it does not in `patience`.
  std::optional<std::string> rest(std::chrono::milliseconds patience = std::chrono::seconds(10));
  /// Whether the server ends the connection.
  bool closes() { return rest().has_value(); }

  /// Ends this direction alone.
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

/// "GET /path HTTP/1.1" with Host and `headers` ("Name: value\r\n" each) and a body where there is one.
std::string request(std::string_view method, std::string_view path, std::string_view headers = {},
                    std::string_view body = {});

}  // namespace adit::intake
