#include "intake/gate.hpp"

#include <linux/tcp.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <array>

namespace adit::intake {
namespace {

constexpr std::size_t kMostThrownAway = 256 * 1024;

/// The kernel copies all unread bytes for each check. If they arrive in small pieces, the gate checks again
/// only after a sixteenth more bytes or after this time: at most 17 copies of the head, and 100 a second.
constexpr std::size_t kWorthALook = 16;
constexpr std::chrono::milliseconds kBetweenLooks(10);

}  // namespace

std::size_t Gate::unread() const {
  int bytes = 0;
  return ::ioctl(fd_, FIONREAD, &bytes) == 0 && bytes > 0 ? static_cast<std::size_t>(bytes) : 0;
}

void Gate::on_request_end() {
  if (stage_ == Stage::Refused) return;
  if (next_ < sound_.size()) {
    stage_ = Stage::Open;
    return;
  }
  stage_ = Stage::Waiting;
  head_ = {};
  looked_at_ = 0;
}

bool Gate::has_unseen() const {
  return stage_ == Stage::Open || (stage_ == Stage::Waiting && looked_at_ == 0 && unread() > 0);
}

Gate::Finding Gate::check_bytes(loop::Instant now, bool at_once) {
  has_new_bytes_ = false;
  if (looked_at_ > 0 && !at_once) {
    const std::size_t there = unread();
    if (there == looked_at_) return Finding::Begun;
    again_at_ = looked_ + kBetweenLooks;
    if (there < looked_at_ + looked_at_ / kWorthALook && now < again_at_) return Finding::Later;
  }
  std::array<char, HeadChecker::kMostBytes> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init)
  const ssize_t size = ::recv(fd_, bytes.data(), bytes.size(), MSG_PEEK | MSG_DONTWAIT);
  if (size <= 0) return Finding::Nothing;
  looked_at_ = static_cast<std::size_t>(size);
  looked_ = now;
  switch (head_.check({bytes.data(), looked_at_})) {
    case HeadChecker::Verdict::More:
      return Finding::Begun;
    case HeadChecker::Verdict::Whole:
      pop_valid_heads({bytes.data(), looked_at_});
      stage_ = Stage::Open;
      return Finding::Whole;
    case HeadChecker::Verdict::Refused:
      break;
  }
  stage_ = Stage::Refused;
  return Finding::Refused;
}

/// Notes the valid heads of the first request and of whole requests after it, because libmicrohttpd reads
/// them together. Not those after a chunked one, or of a chunked one after others: libmicrohttpd must not
/// read it.
void Gate::pop_valid_heads(std::string_view bytes) {
  sound_.clear();
  next_ = 0;
  HeadChecker head = head_;
  while (true) {
    const auto length = head.framing().length;
    if (!length && !sound_.empty()) return;
    sound_.push_back({.head = std::string(bytes.substr(0, head.size())), .framing = head.framing()});
    const std::size_t left = bytes.size() - head.size();
    if (!length || *length >= left) return;
    bytes.remove_prefix(head.size() + static_cast<std::size_t>(*length));
    head = {};
    if (head.check(bytes) != HeadChecker::Verdict::Whole) return;
  }
}

bool Gate::admit_request() {
  if (stage_ != Stage::Open) return false;
  stage_ = Stage::Entered;
  ValidHead& sound = sound_[next_++];
  framing_ = sound.framing;
  head_text_ = std::move(sound.head);
  requests_end_ += head_text_.size() + framing_.length.value_or(0);
  return true;
}

bool Gate::consume_head() {
  if (!admit_request()) return false;
  std::string read(head_text_.size(), '\0');
  return ::recv(fd_, read.data(), read.size(), MSG_DONTWAIT) == static_cast<ssize_t>(read.size());
}

Gate::Traffic Gate::traffic() const {
  tcp_info info{};
  socklen_t size = sizeof info;
  if (::getsockopt(fd_, IPPROTO_TCP, TCP_INFO, &info, &size) != 0) return {requests_end_, 0};
  return {info.tcpi_bytes_received, info.tcpi_bytes_acked};
}

bool Gate::is_passed_by(std::uint64_t received) const {
  if (next_ < sound_.size() || received == requests_end_) return false;
  const std::size_t waits = unread();  // first: bytes that arrive between the calls count as read
  return traffic().received - waits != requests_end_;
}

void Gate::acknowledge_head() const {
  if (framing_.length && traffic().received >= requests_end_) return;
  const int on = 1;
  ::setsockopt(fd_, IPPROTO_TCP, TCP_QUICKACK, &on, sizeof on);
}

bool Gate::discard_received() {
  std::array<char, 16 * 1024> bytes;  // NOLINT(cppcoreguidelines-pro-type-member-init): never looked at
  while (thrown_away_ <= kMostThrownAway) {
    const ssize_t size = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    if (size <= 0) return true;
    thrown_away_ += static_cast<std::size_t>(size);
  }
  return false;
}

}  // namespace adit::intake
