/// A scoring endpoint (ICD 5) that is as fast as it can be and does nothing else: what the paths to it cost
/// is what the benchmark measures. It keeps one count of reports for each token, as a Command Post does for
/// each team.

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <charconv>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "icd/sentence.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::bench {
namespace {

constexpr long kAllotment = 1'000'000;  // reports; no run of the benchmark uses it up
constexpr std::string_view kEndOfHead = "\r\n\r\n";

const auto began = std::chrono::steady_clock::now();

std::string run_clock() {
  return std::to_string(std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count());
}

std::string date_time() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S+00:00", &parts)};
}

/// The value of a field of a request's head, or "". Field names of HTTP are the same in any letter case.
std::string_view field(std::string_view head, std::string_view name) {
  const auto is_name = [&](std::string_view line) {
    if (line.size() <= name.size() || line[name.size()] != ':') return false;
    for (std::size_t i = 0; i < name.size(); ++i)
      if ((line[i] | 0x20) != (name[i] | 0x20)) return false;
    return true;
  };
  while (!head.empty()) {
    const std::size_t end = std::min(head.find("\r\n"), head.size());
    if (const std::string_view line = head.substr(0, end); is_name(line)) {
      const std::string_view value = line.substr(name.size() + 1);
      return value.substr(std::min(value.find_first_not_of(' '), value.size()));
    }
    head.remove_prefix(std::min(end + 2, head.size()));
  }
  return {};
}

std::size_t content_length(std::string_view head) {
  const std::string_view digits = field(head, "content-length");
  std::size_t length = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), length);
  return length;
}

std::string answer(std::string_view status, std::string_view json) {
  return icd::sentence("HTTP/1.1 ", status,
                       "\r\nContent-Type: application/json\r\nContent-Length: ", json.size(), kEndOfHead,
                       json);
}

class ScoringEndpoint {
 public:
  std::string answer_to(std::string_view head, std::string_view body) {
    long& recorded = recorded_[std::string(field(head, "authorization"))];
    if (head.starts_with("POST /state/update")) return answer("200 OK", "\"\"");
    if (head.starts_with("GET /api/status")) return answer("200 OK", status(recorded));
    const bool is_object = body.starts_with('{') && body.ends_with('}');
    if (!head.starts_with("POST /api/artifact_reports") || !is_object)
      return answer("404 Not Found", "\"not here\"");
    return answer("201 Created", recorded_report(body.substr(1, body.size() - 2), ++recorded));
  }

 private:
  static std::string status(long recorded) {
    return icd::sentence(R"({"score": 0, "run_clock": )", run_clock(), R"(, "remaining_reports": )",
                         kAllotment - recorded, R"(, "current_team": "bench"})");
  }

  /// ICD 5.2. x, y, z and type are the members of the report itself, byte for byte.
  static std::string recorded_report(std::string_view members, long id) {
    return icd::sentence(R"({"url": "http://127.0.0.1/api/artifact_reports/)", id, R"(/", "id": )", id, ", ",
                         members, R"(, "submitted_datetime": ")", date_time(), R"(", "run_clock": )",
                         run_clock(),
                         R"(, "team": "bench", "run": "1", "report_status": "scored", "score_change": 0})");
  }

  std::map<std::string, long, std::less<>> recorded_;  // by Authorization
};

/// One kept-alive connection. Its peers send a request and wait for the answer, so that an answer always fits
/// into the socket's buffer.
class Connection {
 public:
  explicit Connection(loop::FileDescriptor fd) : fd_(std::move(fd)) {}

  /// Reads what has come and answers each request that is whole. False where the peer has closed.
  bool serve(ScoringEndpoint& endpoint) {
    std::array<char, 4096> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): recv fills it
    const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
    if (got <= 0) return false;
    unread_.append(bytes.data(), static_cast<std::size_t>(got));
    while (true) {
      const std::size_t head = unread_.find(kEndOfHead);
      if (head == std::string::npos) return true;
      const std::size_t body = head + kEndOfHead.size();
      const std::size_t length = content_length({unread_.data(), head});
      if (unread_.size() < body + length) return true;
      const std::string text = endpoint.answer_to({unread_.data(), head}, {unread_.data() + body, length});
      if (::send(fd_.get(), text.data(), text.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(text.size()))
        return false;
      unread_.erase(0, body + length);
    }
  }

 private:
  loop::FileDescriptor fd_;
  std::string unread_;
};

/// On a free port of loopback; an empty descriptor where that fails.
loop::FileDescriptor listen_on_loopback() {
  loop::FileDescriptor fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (!fd || ::bind(fd.get(), generic, size) != 0 || ::listen(fd.get(), 64) != 0) return {};
  if (::getsockname(fd.get(), generic, &size) != 0) return {};
  std::printf("port %d\n", ntohs(address.sin_port));
  return std::fflush(stdout) == 0 ? std::move(fd) : loop::FileDescriptor();
}

bool watch(int epoll, int fd) {
  epoll_event event{.events = EPOLLIN, .data = {.fd = fd}};
  return ::epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event) == 0;
}

/// Until it is killed, or fails.
int serve() {
  const loop::FileDescriptor listening = listen_on_loopback();
  const loop::FileDescriptor epoll(::epoll_create1(EPOLL_CLOEXEC));
  if (!listening || !epoll || !watch(epoll.get(), listening.get())) return 1;
  ScoringEndpoint endpoint;
  std::map<int, Connection> connections;
  std::array<epoll_event, 16> events{};
  while (true) {
    const int count = ::epoll_wait(epoll.get(), events.data(), static_cast<int>(events.size()), -1);
    for (int i = 0; i < count; ++i) {
      const int fd = events[static_cast<std::size_t>(i)].data.fd;
      if (fd != listening.get()) {
        if (!connections.at(fd).serve(endpoint)) connections.erase(fd);
        continue;
      }
      loop::FileDescriptor accepted(::accept4(fd, nullptr, nullptr, SOCK_CLOEXEC));
      const int yes = 1;
      if (!accepted || !watch(epoll.get(), accepted.get())) continue;
      ::setsockopt(accepted.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      const int number = accepted.get();
      connections.emplace(number, std::move(accepted));
    }
  }
}

}  // namespace
}  // namespace adit::bench

int main() {
  const int status = adit::bench::serve();
  std::perror("adit_bench_scoring");
  return status;
}
