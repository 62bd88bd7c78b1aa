#include "rehearsal/command_post/http.hpp"

#include <array>
#include <boost/beast/http/status.hpp>
#include <ctime>

namespace adit::rehearsal {

std::string utc_text(const char* format, std::chrono::system_clock::time_point time) {
  const std::time_t seconds = std::chrono::system_clock::to_time_t(time);
  std::tm utc{};
  (void)gmtime_r(&seconds, &utc);
  std::array<char, 64> text{};
  return {text.data(), std::strftime(text.data(), text.size(), format, &utc)};
}

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
  namespace http = boost::beast::http;
  const std::string reason(http::obsolete_reason(http::int_to_status(static_cast<unsigned>(answer.status))));
  std::string bytes = "HTTP/1.1 " + std::to_string(answer.status) + " " + reason;
  bytes += "\r\nContent-Length: " + std::to_string(answer.body.size());
  bytes += "\r\nDate: " + utc_text("%a, %d %b %Y %H:%M:%S GMT", now);
  if (!answer.content_type.empty()) bytes += "\r\nContent-Type: " + answer.content_type;
  for (const auto& [name, value] : answer.headers)
    bytes.append("\r\n").append(name).append(": ").append(value);
  bytes += outcome.after == After::Close ? "\r\nConnection: close" : "\r\nConnection: keep-alive";
  bytes += "\r\n\r\n";
  if (!head) bytes += answer.body;
  return bytes;
}

}  // namespace adit::rehearsal
