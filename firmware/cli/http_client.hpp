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
  std::string body = "";  // of a POST: JSON, or nothing
  std::string content_type = "application/json";
};

using HttpReply = uplink::Answered;

struct NoReply {
  std::string sentence;  // names the address
  bool sent = false;     // the request may have arrived all the same
};

/// One blocking request (RFC 9112) on a connection of its own: the whole reply, or why there is none. All of
/// it within `within`.
std::expected<HttpReply, NoReply> http_ask(const settings::Address& address, HttpRequest request,
                                           std::chrono::milliseconds within);

/// A request whose answer goes on for as long as both like.
class HttpStream {
 public:
  /// Asks within that time; the answer is still to come. A sentence that names the address: why it could not.
  static std::expected<std::unique_ptr<HttpStream>, std::string> ask(const settings::Address& address,
                                                                     HttpRequest request,
                                                                     std::chrono::milliseconds within);
  HttpStream(loop::FileDescriptor fd, const uplink::Endpoint& endpoint, const icd::BearerToken& token,
             uplink::Request request);

  /// Something comes there, or its end.
  int fd() const { return fd_.get(); }

  struct Ended {
    int status = 0;  // with which it was answered in the place of 200; 0: it was, or not at all
    std::string why;
  };
  /// What has come of a 200's body since the last call, without waiting.
  std::expected<std::string, Ended> read();

 private:
  void look();

  loop::FileDescriptor fd_;
  uplink::Exchange exchange_;
  std::optional<Ended> ended_;
};

}  // namespace adit::cli
