#pragma once

#include <chrono>
#include <expected>
#include <string>

#include "icd/bearer_token.hpp"
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

}  // namespace adit::cli
