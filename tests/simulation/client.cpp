#include "simulation/client.hpp"

#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <utility>

#include "simulation/messages.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {

Client::Client(World& world, std::string address, Manners manners, Random random)
    : world_(world), address_(std::move(address)), manners_(manners), random_(random) {}

Client::~Client() {
  close();
}

void Client::connect() {
  fd_ = world_.door().connect(address_);
  watch_ =
      world_.descriptors().add(fd_, EPOLLIN | EPOLLRDHUP, [this](std::uint32_t events) { ready(events); });
}

void Client::close() {
  if (fd_ < 0) return;
  world_.descriptors().remove(watch_);
  world_.door().closed(fd_);
  ::close(std::exchange(fd_, -1));
  answers_ = {};
}

void Client::ask_several(std::string request, std::vector<Event> about, std::function<void(int)> done) {
  if (!needed_ && world_.omits("client " + address_))
    return world_.after({}, [done = std::move(done)] { done(0); });
  request_ = std::move(request);
  const std::uint64_t id = world_.entropy();
  done_ = std::move(done);
  written_ = 0;
  hang_up_at_ = random_.chance(manners_.hangs_up) ? 1 + random_.uniform_index(request_.size()) : 0;
  half_close_ = random_.chance(manners_.half_closes);
  stalls_at_ = random_.chance(manners_.stalls) ? 1 + random_.uniform_index(request_.size() - 1) : 0;
  pauses_at_ = 0;
  if (manners_.pauses > 0 && random_.chance(manners_.pauses)) {
    const std::size_t head = request_.find("\r\n\r\n") + 4;
    pauses_at_ = head + random_.uniform_index(request_.size() - head);
  }
  const std::uint64_t number = ++number_;
  if (fd_ < 0) connect();
  for (Event& event : about) {
    event.actor = Actor::Team;
    event.kind = Kind::Invoke;
    event.request = id;
    world_.note(event);
  }
  about_ = std::move(about.front());
  world_.after(seconds(manners_.patience), [this, number] {
    if (number == number_ && done_) gone("out of patience");
  });
  go_on();
}

void Client::go_on() {
  if (!done_ || fd_ < 0 || written_ == request_.size()) return;
  if (stalls_at_ != 0 && written_ >= stalls_at_) return stall();
  const std::size_t left = request_.size() - written_;
  const bool dribbles = random_.chance(manners_.dribbles);
  write(dribbles ? 1 + random_.uniform_index(left) : left);
  if (!done_ || written_ == request_.size()) return;
  const bool pauses = pauses_at_ != 0 && written_ == pauses_at_;
  if (pauses) pauses_at_ = 0;
  const double delay = pauses ? random_.uniform(1, 8) : random_.uniform(0.0005, dribbles ? 0.5 : 0.01);
  const std::uint64_t number = number_;
  world_.after(seconds(delay), [this, number] {
    if (number == number_) go_on();
  });
}

void Client::stall() {
  Event event = about_;
  event.kind = Kind::Stalls;
  event.status = request_.find("\r\n\r\n") + 4 < written_ ? kInBody : kInHead;
  world_.note(std::move(event));
}

void Client::write(std::size_t most) {
  if (stalls_at_ != 0) most = std::min(most, stalls_at_ - written_);
  if (pauses_at_ != 0) most = std::min(most, pauses_at_ - written_);
  if (hang_up_at_ != 0) most = std::min(most, hang_up_at_ - written_);
  const ssize_t taken = ::send(fd_, request_.data() + written_, most, MSG_NOSIGNAL | MSG_DONTWAIT);
  if (taken < 0 && errno == EAGAIN) return;
  if (taken < 0) return gone("reset");
  written_ += static_cast<std::size_t>(taken);
  if (written_ == request_.size()) {
    Event event = about_;
    event.kind = Kind::Whole;
    if (half_close_) event.text = "and ends its direction";
    world_.note(std::move(event));
    if (half_close_) ::shutdown(fd_, SHUT_WR);
  }
  if (hang_up_at_ != 0 && written_ == hang_up_at_) gone("hung up");
}

void Client::ready(std::uint32_t) {
  read();
}

void Client::read() {
  std::array<char, 16384> bytes{};
  const ssize_t got = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (got < 0 && errno == EAGAIN) return;
  if (got <= 0) return done_ ? gone("cut") : close();
  answers_.feed({bytes.data(), static_cast<std::size_t>(got)});
  while (const auto answer = answers_.next()) {
    if (answer->status() < 200 || !done_) continue;
    const bool stays = manners_.keeps_alive && !half_close_ && answer->header("connection") != "close";
    heard_ = answer->body;
    heard(*answer);
    if (!stays) close();
  }
}

void Client::heard(const HttpMessage& answer) {
  Event event = about_;
  event.kind = Kind::Answered;
  event.status = answer.status();
  if (event.status >= 300) event.text = answer.body;
  if (event.what == kStatus && event.status == 200) {
    event.says = status_in(answer.body);
    event.stamp = std::atof(answer.header("age").c_str());
  }
  ended(std::move(event));
}

/// A client that heard no answer closes the connection.
void Client::gone(const std::string& why) {
  close();
  Event event = about_;
  event.kind = Kind::Gone;
  event.text = why;
  ended(std::move(event));
}

void Client::ended(Event event) {
  const int status = event.status;
  world_.note(std::move(event));
  const auto done = std::exchange(done_, nullptr);
  ++number_;
  // Not from within this call, because `done` may ask again.
  world_.after({}, [done, status] { done(status); });
}

}  // namespace adit::simulation
