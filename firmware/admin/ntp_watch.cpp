#include "admin/ntp_watch.hpp"

#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cmath>

#include "settings/subnet.hpp"

namespace adit::admin {
namespace {

constexpr std::chrono::seconds kAnswer{1};

loop::FileDescriptor connected_to(std::uint16_t port) {
  loop::FileDescriptor fd(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (fd && connect(fd.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) return {};
  return fd;
}

}  // namespace

void NtpWatch::every_second(const std::string& server) {
  const auto wanted = settings::ipv4_of(server);
  if (wanted != server_) told_.reset();
  server_ = wanted;
  if (!server_) {
    answers_ = {};
    socket_ = {};
  } else if (!is_asked_ || loop_.now() >= asked_at_ + kAnswer) {
    ask();
  }
}

/// A failed request is repeated later.
void NtpWatch::ask() {
  asked_at_ = loop_.now();
  is_asked_ = true;
  if (!socket_) {
    socket_ = connected_to(port_);
    if (!socket_) return;
    answers_ = loop_.watch(socket_.get(), EPOLLIN, [this](std::uint32_t) { hear(); });
  }
  const auto request = clock::tracking_request(++number_);
  (void)send(socket_.get(), request.data(), request.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

void NtpWatch::hear() {
  std::array<std::uint8_t, 512> bytes{};
  constexpr int kAtOnce = 8;
  for (int i = 0; i < kAtOnce; ++i) {
    const ssize_t size = recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size < 0) return;
    if (auto told = clock::read_tracking({bytes.data(), static_cast<std::size_t>(size)}, number_)) {
      told_ = *told;
      is_asked_ = false;
      told_at_ = loop_.now();
    }
  }
}

std::optional<double> NtpWatch::behind() const {
  if (!told_ || !server_ || loop_.now() >= told_at_ + kGone) return std::nullopt;
  if (told_->server != *server_ || std::abs(system_now() - told_->heard) > kSilence) return std::nullopt;
  return told_->behind;
}

}  // namespace adit::admin
