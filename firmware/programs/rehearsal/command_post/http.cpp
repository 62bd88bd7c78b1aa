#include "rehearsal/command_post/http.hpp"

#include <array>
#include <ctime>

namespace adit::rehearsal {
namespace {

std::string_view reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 201:
      return "Created";
    case 301:
      return "Moved Permanently";
    case 308:
      return "Permanent Redirect";
    case 400:
      return "Bad Request";
    case 401:
      return "Unauthorized";
    case 404:
      return "Not Found";
    case 405:
      return "Method Not Allowed";
    case 408:
      return "Request Timeout";
    case 409:
      return "Conflict";
    case 413:
      return "Content Too Large";
    case 415:
      return "Unsupported Media Type";
    case 422:
      return "Unprocessable Entity";
    case 429:
      return "Too Many Requests";
    case 431:
      return "Request Header Fields Too Large";
    case 500:
      return "Internal Server Error";
    case 501:
      return "Not Implemented";
    default:
      return "";
  }
}

/// "Sun, 06 Nov 1994 08:49:37 GMT" (RFC 9110 5.6.7); no program here has a locale.
std::string http_date(std::chrono::system_clock::time_point now) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(now);
  std::tm utc{};
  (void)gmtime_r(&seconds, &utc);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%a, %d %b %Y %H:%M:%S GMT", &utc)};
}

}  // namespace

std::string_view path_of(std::string_view target) {
  constexpr std::string_view scheme = "http://";
  if (target.starts_with(scheme)) {
    const auto slash = target.find('/', scheme.size());
    target = slash == std::string_view::npos ? "/" : target.substr(slash);
  }
  return target.substr(0, target.find('?'));
}

std::string bytes_of(const Outcome& outcome, bool head, std::chrono::system_clock::time_point now) {
  const Answer& answer = outcome.answer;
  std::string bytes =
      "HTTP/1.1 " + std::to_string(answer.status) + " " + std::string(reason_of(answer.status));
  bytes += "\r\nContent-Length: " + std::to_string(answer.body.size());
  bytes += "\r\nDate: " + http_date(now);
  if (!answer.content_type.empty()) bytes += "\r\nContent-Type: " + answer.content_type;
  for (const auto& [name, value] : answer.headers)
    bytes.append("\r\n").append(name).append(": ").append(value);
  bytes += outcome.after == After::Close ? "\r\nConnection: close" : "\r\nConnection: keep-alive";
  bytes += "\r\n\r\n";
  if (!head) bytes += answer.body;
  return bytes;
}

}  // namespace adit::rehearsal
