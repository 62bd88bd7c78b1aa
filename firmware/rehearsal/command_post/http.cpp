#include "rehearsal/command_post/http.hpp"

namespace adit::rehearsal {
namespace {

std::string_view reason_of(int status) {
  switch (status) {
    case 200:
      return "OK";
    case 201:
      return "Created";
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

}  // namespace

std::string_view path_of(std::string_view target) {
  constexpr std::string_view scheme = "http://";
  if (target.starts_with(scheme)) {
    const auto slash = target.find('/', scheme.size());
    target = slash == std::string_view::npos ? "/" : target.substr(slash);
  }
  return target.substr(0, target.find('?'));
}

std::string bytes_of(const Outcome& outcome, bool head) {
  const Answer& answer = outcome.answer;
  std::string bytes =
      "HTTP/1.1 " + std::to_string(answer.status) + " " + std::string(reason_of(answer.status));
  bytes += "\r\nContent-Length: " + std::to_string(answer.body.size());
  if (!answer.content_type.empty()) bytes += "\r\nContent-Type: " + answer.content_type;
  for (const auto& [name, value] : answer.headers)
    bytes.append("\r\n").append(name).append(": ").append(value);
  bytes += outcome.after == After::Close ? "\r\nConnection: close" : "\r\nConnection: keep-alive";
  bytes += "\r\n\r\n";
  if (!head) bytes += answer.body;
  return bytes;
}

}  // namespace adit::rehearsal
