#include "client.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "icd/sentence.hpp"

namespace adit::bench {

std::unexpected<std::string> system_error(std::string_view doing) {
  return std::unexpected(icd::sentence(doing, ": ", std::strerror(errno)));
}

namespace {

constexpr timeval kPatience{.tv_sec = 10, .tv_usec = 0};
constexpr std::string_view kEndOfHead = "\r\n\r\n";

/// On a lattice of 10 m. Halves are exact, so that any reader gives back these digits.
std::string position(std::uint64_t number) {
  return icd::sentence("\"x\": ", 10 * (number % 100), ".5, \"y\": ", 10 * (number / 100 % 100),
                       ".5, \"z\": ", 10 * (number / 10'000), ".5");
}

std::string report(std::uint64_t number) {
  return icd::sentence("{", position(number), ", \"type\": \"Backpack\"}");
}

std::string state(std::uint64_t number) {
  std::string poses;
  for (std::uint64_t robot = 0; robot < 10; ++robot) {
    poses += icd::sentence(robot == 0 ? "" : ", ", "{\"name\": \"robot_", robot, "\", \"position\": {",
                           position(number + robot), "}, \"orientation\": {\"x\": 0.0, \"y\": 0.0, ",
                           R"("z": 0.3826834323650898, "w": 0.9238795325112867}})");
  }
  return icd::sentence(R"({"header": {"stamp": {"secs": )", 1'600'000'000 + number / 1000, R"(, "nsecs": )",
                       number % 1000 * 1'000'000, R"(}, "frame_id": "darpa"}, "poses": [)", poses, "]}");
}

/// The length of the whole answer, once its head is there; 0 before.
std::size_t whole_size(std::string_view text) {
  const std::size_t head = text.find(kEndOfHead);
  if (head == std::string_view::npos) return 0;
  // All four servers write it in one of these two ways.
  for (const std::string_view name : {"\r\nContent-Length: ", "\r\ncontent-length: "}) {
    const std::size_t at = text.find(name);
    if (at < head)
      return head + kEndOfHead.size() + std::strtoul(text.data() + at + name.size(), nullptr, 10);
  }
  return head + kEndOfHead.size();
}

}  // namespace

std::string body_of(Kind kind, std::uint64_t number) {
  return kind == Kind::Reports ? report(number) : state(number);
}

std::expected<Client, std::string> Client::connect(std::uint16_t port, const std::string& token, Kind kind) {
  const std::string where = icd::sentence("127.0.0.1:", port);
  loop::FileDescriptor fd(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  if (!fd || ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
    return system_error(icd::sentence("connecting to ", where));
  const int yes = 1;
  ::setsockopt(fd.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
  ::setsockopt(fd.get(), SOL_SOCKET, SO_RCVTIMEO, &kPatience, sizeof kPatience);
  const std::string_view uri = kind == Kind::Reports ? "/api/artifact_reports" : "/state/update";
  std::string head = icd::sentence("POST ", uri, " HTTP/1.1\r\nHost: ", where, "\r\nAuthorization: Bearer ",
                                   token, "\r\nContent-Type: application/json\r\nContent-Length: ");
  return Client(std::move(fd), std::move(head), kind);
}

bool Client::is_answered(std::string_view answer, std::uint64_t number) const {
  if (kind_ == Kind::States) return answer.starts_with("HTTP/1.1 200 ");
  return answer.starts_with("HTTP/1.1 201 ") && answer.contains(position(number));
}

std::expected<Clock::duration, std::string> Client::post(std::uint64_t number) {
  const std::string body = body_of(kind_, number);
  const std::string request = icd::sentence(head_, body.size(), kEndOfHead, body);
  const Clock::time_point began = Clock::now();
  if (::send(fd_.get(), request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
    return system_error("sending a message");
  const auto text = answer();
  const Clock::duration took = Clock::now() - began;
  if (!text) return std::unexpected(text.error());
  if (!is_answered(*text, number))
    return std::unexpected(icd::sentence("expected the answer to ", body, ", got ", *text));
  return took;
}

std::expected<std::string, std::string> Client::answer() {
  std::string text;
  std::array<char, 4096> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): recv fills it
  while (true) {
    const ssize_t got = ::recv(fd_.get(), bytes.data(), bytes.size(), 0);
    if (got < 0) return system_error("waiting for an answer");
    if (got == 0) return std::unexpected("the connection was closed instead of an answer: " + text);
    text.append(bytes.data(), static_cast<std::size_t>(got));
    if (const std::size_t whole = whole_size(text); whole > 0 && text.size() >= whole) return text;
  }
}

}  // namespace adit::bench
