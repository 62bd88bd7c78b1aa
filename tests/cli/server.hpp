#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <string>
#include <thread>

#include "settings/settings.hpp"

namespace adit::cli {

/// Listens on loopback and gives each connection the same bytes, whatever it asks, then closes. With
/// `silent`, it keeps the connection and says nothing more.
class Server {
 public:
  explicit Server(std::string answer, bool silent = false) : answer_(std::move(answer)), silent_(silent) {
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
  ~Server() {
    ended_ = true;
    thread_.join();
    close(fd_);
  }
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  settings::Address address() const { return {"127.0.0.1", port_}; }
  std::string at() const { return "127.0.0.1:" + std::to_string(port_); }
  /// What the last client sent. After the server has ended, or the client has its answer.
  const std::string& request() const { return request_; }

  static std::string ok(const std::string& body) {
    return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n\r\n" + body;
  }

 private:
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
    char buffer[4096];
    const ssize_t size = recv(client, buffer, sizeof buffer, 0);
    if (size > 0) request_.assign(buffer, static_cast<std::size_t>(size));
    send(client, answer_.data(), answer_.size(), MSG_NOSIGNAL);
    while (silent_ && !ended_) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }

  std::string answer_;
  bool silent_;
  int fd_ = -1;
  std::uint16_t port_ = 0;
  std::string request_;
  std::atomic<bool> ended_ = false;
  std::thread thread_;
};

}  // namespace adit::cli
