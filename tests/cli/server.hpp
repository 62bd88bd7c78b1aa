#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>

#include "settings/settings.hpp"

namespace adit::cli {

/// Listens on loopback. Answers each connection once and closes it. With `silent`, keeps the connection
/// open without further bytes.
class Server {
 public:
  using Answers = std::map<std::string, std::string>;  // by "POST /adit/runs"

  /// Always sends the same answer.
  explicit Server(const std::string& answer, bool silent = false) : Server({{"", answer}}, silent) {}
  /// Answers 404 to requests that are not in `answers`.
  explicit Server(Answers answers) : Server(std::move(answers), false) {}
  ~Server() {
    ended_ = true;
    thread_.join();
    close(fd_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  settings::Address address() const { return {"127.0.0.1", port_}; }
  std::string at() const { return "127.0.0.1:" + std::to_string(port_); }
  /// The last request. Call after the server has ended or the client has its answer.
  const std::string& request() const { return request_; }
  /// The last POST.
  const std::string& posted() const { return posted_; }

  static std::string reply(const std::string& status, const std::string& body) {
    return "HTTP/1.1 " + status +
           "\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
           "\r\n\r\n" + body;
  }
  static std::string ok(const std::string& body) { return reply("200 OK", body); }

 private:
  Server(Answers answers, bool silent) : answers_(std::move(answers)), silent_(silent) {
    fd_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in name{};
    name.sin_family = AF_INET;
    name.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof name;
    const bool listens = bind(fd_, reinterpret_cast<const sockaddr*>(&name), size) == 0 &&
                         listen(fd_, 4) == 0 &&
                         getsockname(fd_, reinterpret_cast<sockaddr*>(&name), &size) == 0;
    if (!listens) std::abort();
    port_ = ntohs(name.sin_port);
    thread_ = std::thread([this] { serve(); });
  }
  void serve() {
    while (!ended_) {
      pollfd entry{fd_, POLLIN, 0};
      if (poll(&entry, 1, 20) <= 0) continue;
      const int client = accept(fd_, nullptr, nullptr);
      answer(client);
      close(client);
    }
  }

  void answer(int client) {
    request_ = received(client);
    if (request_.starts_with("POST ")) posted_ = request_;
    const std::string answer = answer_to(request_.substr(0, request_.find(" HTTP/")));
    send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
    while (silent_ && !ended_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  /// Reads a complete request, or the part before the client closes.
  static std::string received(int client) {
    std::string request;
    char buffer[4096];
    while (!is_whole(request)) {
      const ssize_t size = recv(client, buffer, sizeof buffer, 0);
      if (size <= 0) break;
      request.append(buffer, static_cast<std::size_t>(size));
    }
    return request;
  }

  static bool is_whole(const std::string& request) {
    const std::size_t head = request.find("\r\n\r\n");
    if (head == std::string::npos) return false;
    const std::size_t length = request.find("Content-Length: ");
    if (length == std::string::npos || length > head) return true;
    return request.size() - head - 4 >= std::stoul(request.substr(length + 16));
  }

  std::string answer_to(const std::string& asked) const {
    const auto all = answers_.find(""), one = answers_.find(asked);
    if (all != answers_.end()) return all->second;
    return one == answers_.end() ? reply("404 Not Found", "\"there is no resource at this path\"")
                                 : one->second;
  }

  Answers answers_;
  bool silent_;
  int fd_ = -1;
  std::uint16_t port_ = 0;
  std::string request_, posted_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

}  // namespace adit::cli
