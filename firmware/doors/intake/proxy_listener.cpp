#include "intake/proxy_listener.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <iterator>
#include <utility>

#include "icd/text.hpp"
#include "intake/listen_socket.hpp"

namespace adit::intake {
namespace {

/// As many as libmicrohttpd accepts at once.
constexpr int kAcceptsAtOnce = 10;

/// Removes the first word of `line` and the blank after it.
std::string_view take_word(std::string_view& line) {
  const std::string_view word = line.substr(0, line.find(' '));
  line.remove_prefix(std::min(word.size() + 1, line.size()));
  return word;
}

/// As address_text() has it; "": not an address. Accepts an interface after it ("fe80::1%team0").
std::string canonical(int family, std::string_view address) {
  sockaddr_storage parsed{};
  parsed.ss_family = static_cast<sa_family_t>(family);
  void* const bytes = family == AF_INET
                          ? static_cast<void*>(&reinterpret_cast<sockaddr_in*>(&parsed)->sin_addr)
                          : static_cast<void*>(&reinterpret_cast<sockaddr_in6*>(&parsed)->sin6_addr);
  const std::string text(address.substr(0, family == AF_INET6 ? address.find('%') : std::string_view::npos));
  if (::inet_pton(family, text.c_str(), bytes) != 1) return "";
  return address_text(reinterpret_cast<const sockaddr*>(&parsed));
}

}  // namespace

std::expected<ProxyHeader, ProxyHeader::Missing> ProxyHeader::parse(std::string_view bytes) {
  constexpr std::string_view kBegin = "PROXY TCP", kEnd = "\r\n";
  if (!bytes.starts_with(kBegin.substr(0, bytes.size()))) return std::unexpected(Missing::Refused);
  const auto end = bytes.substr(0, kMostBytes).find(kEnd);
  if (end == std::string_view::npos)
    return std::unexpected(bytes.size() < kMostBytes ? Missing::More : Missing::Refused);
  std::string_view line = bytes.substr(kBegin.size(), end - kBegin.size());
  const std::string_view version = take_word(line);
  const int family = version == "4" ? AF_INET : version == "6" ? AF_INET6 : AF_UNSPEC;
  if (family == AF_UNSPEC) return std::unexpected(Missing::Refused);
  ProxyHeader header{.size = end + kEnd.size(), .peer = {}, .local = {}};
  header.peer = canonical(family, take_word(line));
  header.local = canonical(family, take_word(line));
  const auto from = icd::number_in<std::uint16_t>(take_word(line)), to = icd::number_in<std::uint16_t>(line);
  if (header.peer.empty() || header.local.empty() || !from || !to) return std::unexpected(Missing::Refused);
  return header;
}

ProxyListener::ProxyListener(loop::Loop& loop, loop::FileDescriptor listening,
                             std::chrono::milliseconds within, Admit admit)
    : loop_(loop),
      within_(within),
      admit_(std::move(admit)),
      listening_(std::move(listening)),
      connects_(loop.watch(listening_.get(), EPOLLIN, [this](std::uint32_t) { accept_some(); })),
      late_(loop.timer([this] { close_late(); })) {}

void ProxyListener::accept_some() {
  for (int left = kAcceptsAtOnce; left > 0; --left) {
    loop::FileDescriptor connection(
        ::accept4(listening_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!connection) return;
    if (waiting_.size() == kMostWaiting) waiting_.pop_front();
    waiting_.push_back({std::move(connection), loop_.now() + within_, {}});
    const auto last = std::prev(waiting_.end());
    // Edge-triggered, because the bytes of an incomplete header stay in the socket.
    last->arrivals = loop_.watch(last->connection.get(), EPOLLIN | EPOLLRDHUP | EPOLLET,
                                 [this, last](std::uint32_t) { read_header(last); });
    if (waiting_.size() == 1) late_.call_at(last->until);
  }
}

void ProxyListener::read_header(std::list<PendingConnection>::iterator waiting) {
  std::array<char, ProxyHeader::kMostBytes> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  const int fd = waiting->connection.get();
  const ssize_t size = ::recv(fd, bytes.data(), bytes.size(), MSG_PEEK);
  if (size < 0 && errno == EAGAIN) return;
  std::expected<ProxyHeader, ProxyHeader::Missing> header(std::unexpect, ProxyHeader::Missing::Refused);
  if (size > 0) header = ProxyHeader::parse({bytes.data(), static_cast<std::size_t>(size)});
  if (!header && header.error() == ProxyHeader::Missing::More) return;
  PendingConnection done = std::move(*waiting);
  waiting_.erase(waiting);
  done.arrivals = {};
  if (header && ::recv(fd, bytes.data(), header->size, 0) == static_cast<ssize_t>(header->size))
    admit_(std::move(done.connection), std::move(*header));
}

void ProxyListener::close_late() {
  std::erase_if(waiting_, [now = loop_.now()](const PendingConnection& each) { return each.until <= now; });
  if (!waiting_.empty()) late_.call_at(waiting_.front().until);
}

}  // namespace adit::intake
