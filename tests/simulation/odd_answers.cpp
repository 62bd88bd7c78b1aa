#include "simulation/odd_answers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>

#include "simulation/bytes.hpp"
#include "simulation/http.hpp"

namespace adit::simulation {
namespace {

constexpr const char* kElsewhere = "<html><body>Look elsewhere</body></html>";
constexpr const char* kLength = "Content-Length: ";

struct Parts {
  std::string head, body;  // the head without its length and its empty line
};

Parts parts_of(const std::string& answer) {
  const std::size_t end = answer.find("\r\n\r\n"), length = answer.find(kLength);
  return {answer.substr(0, length), answer.substr(end + 4)};
}

std::string chunked(const Parts& parts, Random& random) {
  std::string text = parts.head + "Transfer-Encoding: chunked\r\n\r\n";
  for (std::size_t at = 0; at < parts.body.size();) {
    const std::size_t size = 1 + random.uniform_index(parts.body.size() - at);
    char head[32];
    std::snprintf(head, sizeof head, "%zx\r\n", size);
    text += head + parts.body.substr(at, size) + "\r\n";
    at += size;
  }
  return text + "0\r\n\r\n";
}

}  // namespace

std::string in_another_form(const std::string& answer, Random& random) {
  if (random.chance(0.5)) return chunked(parts_of(answer), random);
  constexpr const char* kInterim[] = {"HTTP/1.1 100 Continue\r\n\r\n", "HTTP/1.1 102 Processing\r\n\r\n",
                                      "HTTP/1.1 103 Early Hints\r\nLink: </a>; rel=preload\r\n\r\n"};
  return kInterim[random.uniform_index(std::size(kInterim))] + answer;
}

std::string with_wrong_length(const std::string& answer, Random& random) {
  const Parts parts = parts_of(answer);
  const std::size_t off = 1 + random.uniform_index(std::max<std::size_t>(parts.body.size(), 2) - 1);
  const std::size_t length =
      random.chance(0.5) ? parts.body.size() + off : parts.body.size() - std::min(off, parts.body.size());
  return parts.head + kLength + std::to_string(length) + "\r\n\r\n" + parts.body;
}

std::string with_wrong_types(Random& random) {
  constexpr const char* kBodies[] = {
      "[]",
      "{}",
      "\"ok\"",
      "{\"score\": \"many\", \"run_clock\": null}",
      "{\"id\": [], \"report_status\": 3, \"score_change\": \"1\", \"run\": {}}",
      "true"};
  return http_answer(random.chance(0.5) ? "200 OK" : "201 Created", kJson,
                     kBodies[random.uniform_index(std::size(kBodies))]);
}

std::string redirect(Random& random) {
  constexpr const char* kLines[] = {"301 Moved Permanently", "302 Found", "307 Temporary Redirect",
                                    "308 Permanent Redirect"};
  return http_answer(kLines[random.uniform_index(std::size(kLines))],
                     "Location: http://portal.example/\r\nContent-Type: text/html\r\n",
                     random.chance(0.5) ? kElsewhere : "");
}

std::string from_between(Random& random, const std::string& fields) {
  constexpr const char* kLines[] = {"502 Bad Gateway", "503 Service Unavailable", "504 Gateway Timeout"};
  return http_answer(kLines[random.uniform_index(std::size(kLines))], "Content-Type: text/html\r\n" + fields,
                     kElsewhere);
}

std::string retry_after(Random& random, double now, std::uint64_t seconds) {
  constexpr double kOff = 1e7;  // seconds
  const auto date = [](double time) {
    const auto whole = static_cast<std::time_t>(time);
    std::tm parts{};
    char text[64];
    std::strftime(text, sizeof text, "%a, %d %b %Y %H:%M:%S GMT", gmtime_r(&whole, &parts));
    return std::string(text);
  };
  const bool is_date = random.chance(0.4), is_long = random.chance(0.03);
  if (is_long) return "Retry-After: 99999999999\r\n";
  if (!is_date) return "Retry-After: " + std::to_string(seconds) + "\r\n";
  const double there = std::floor(now - kOff);
  return "Date: " + date(there) + "\r\nRetry-After: " + date(there + static_cast<double>(seconds)) + "\r\n";
}

std::string gzipped(const std::string& answer) {
  const Parts parts = parts_of(answer);
  const std::string member = deflated(parts.body);
  return parts.head + "Content-Encoding: gzip\r\n" + kLength + std::to_string(member.size()) + "\r\n\r\n" +
         member;
}

}  // namespace adit::simulation
