#pragma once

#include <chrono>
#include <expected>
#include <memory>
#include <optional>
#include <string>

#include "icd/bearer_token.hpp"
#include "loop/file_descriptor.hpp"
#include "settings/settings.hpp"
#include "uplink/exchange.hpp"

namespace adit::cli {

inline constexpr std::size_t kLargestBody = 8u << 20;

struct HttpRequest {
  enum class Method : std::uint8_t { Get, Post } method = Method::Get;
  std::string target;  // "/adit/run"
  icd::BearerToken token;
  std::string body = "";  // of a POST: JSON or ""
  std::string content_type = "application/json";
};

using HttpReply = uplink::Answered;

struct NoReply {
  std::string sentence;  // with the address
  bool sent = false;     // the request may have arrived
};

/// One blocking request (RFC 9112) on its own connection, with its whole reply, within `within`.
std::expected<HttpReply, NoReply> http_ask(const settings::Address& address, HttpRequest request,
                                           std::chrono::milliseconds within);

/// A request with an endless answer.
class HttpStream {
 public:
  /// Sends the request within `within`. An error names the address.
  static std::expected<std::unique_ptr<HttpStream>, std::string> ask(const settings::Address& address,
                                                                     HttpRequest request,
                                                                     std::chrono::milliseconds within);
  HttpStream(loop::FileDescriptor fd, const uplink::Endpoint& endpoint, const icd::BearerToken& token,
             uplink::Request request);

  /// Readable if there is data or the end.
  int fd() const { return fd_.get(); }

  struct Ended {
    int status = 0;  // of an answer other than 200; 0: the answer was 200, or absent
    std::string why;
  };
  /// The new data of a 200's body. Does not block.
  std::expected<std::string, Ended> read();

 private:
  void look();

  loop::FileDescriptor fd_;
  uplink::Exchange exchange_;
  std::optional<Ended> ended_;
};

}  // namespace adit::cli
