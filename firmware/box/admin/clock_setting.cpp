#include "admin/clock_setting.hpp"

#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/socket.h>

#include <array>
#include <cmath>

#include "host/log.hpp"
#include "icd/sentence.hpp"
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

/// At its start chronyd asks four times in six seconds.
constexpr std::chrono::seconds kFirstAnswer{30};

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
    answers_ = loop_.watch(socket_.get(), EPOLLIN, [this](std::uint32_t) { read_answers(); });
  }
  const auto request = clock::tracking_request(++number_);
  (void)send(socket_.get(), request.data(), request.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
}

void NtpWatch::read_answers() {
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

std::optional<double> NtpWatch::offset() const {
  if (!told_ || !server_ || loop_.now() >= told_at_ + kGone) return std::nullopt;
  if (told_->server != *server_ || std::abs(system_now() - told_->heard) > kSilence) return std::nullopt;
  return told_->behind;
}

api::ClockView ClockSetting::state() const {
  const auto status = adit_clock_.status();
  api::ClockView view{.now = loop_.wall_now(),
                      .managed = status != nullptr,
                      .why = adit_clock_.status_error(),
                      .refusal = trouble()};
  view.ntp = ntp_text();
  view.is_kept = is_kept_by_ntp();
  view.is_set = is_set().value_or(!adit_clock_.is_starting());
  if (!status) return view;
  view.source = status->source;
  if (!adit_clock_.is_pending() && view.refusal.empty()) view.refusal = status->refusal;
  return view;
}

std::optional<bool> ClockSetting::is_set() const {
  if (const auto status = adit_clock_.status()) return clock::is_set(status->source);
  if (adit_clock_.runs_here() && !adit_clock_.is_starting()) return false;  // its status cannot be read
  return loop_.wall_now() < clock::kEarliest ? std::optional(false) : std::nullopt;
}

bool ClockSetting::has_source() const {
  const auto status = adit_clock_.status();
  return status && clock::is_set(status->source) && status->source != clock::Source::Chip;
}

icd::Checked<void> ClockSetting::set_clock(double time) {
  const auto status = adit_clock_.status();
  if (!status) return adit_clock_.refuse();
  if (is_kept_by_ntp())
    return icd::conflict("the NTP server ", ntp_.server, " keeps the time: clock.ntp_server in the settings");
  if (!clock::time_to_set(status->source, {clock::Source::Operator, time}, loop_.wall_now()))
    return icd::refuse(icd::Status::UnprocessableEntity,
                       "time: expected seconds since 1970, from 2026 to 2099");
  if (const auto asked = ask(clock::Source::Operator, time); !asked)
    return icd::refuse(icd::Status::ServiceUnavailable, asked.error());
  return {};
}

void ClockSetting::on_offered(const clock::Offer& offer) {
  const auto status = adit_clock_.status();
  if (!status || adit_clock_.is_pending()) return;
  const bool came_to_nothing = !trouble().empty() || !status->refusal.empty();
  if (came_to_nothing && loop_.now() < asked_at_ + kAskAgain) return;  // set_clock() has no such limit
  const double of_the_system = loop_.wall_now() - loop_.wall_offset();
  const auto time = clock::time_to_set(status->trusted_source(), offer, of_the_system);
  if (!time) return;
  if (const auto asked = ask(offer.source, *time); !asked) not_written_ = asked.error();
}

std::expected<void, std::string> ClockSetting::ask(clock::Source source, double time) {
  const auto status = adit_clock_.status();
  const clock::Request request{.nonce = host::draw_nonce(),
                               .source = source,
                               .time = time,
                               .at = std::chrono::duration<double>(loop_.now().time_since_epoch()).count(),
                               .boot = status ? status->boot : "",
                               .server = source == clock::Source::Ntp ? ntp_.server : ""};
  auto written = adit_clock_.ask(clock::kRequestFile, request);
  if (!written) return written;
  asked_at_ = loop_.now();
  not_written_.clear();
  return {};
}

void ClockSetting::every_second(const clock::Ntp& ntp) {
  adit_clock_.check();
  const auto status = adit_clock_.status();
  if (ntp_ != ntp || ntp_since_ == loop::Instant{}) ntp_since_ = loop_.now();
  if (std::exchange(ntp_, ntp) != ntp) ntp_asked_at_ = {};
  watch_.every_second(status ? ntp_.server : "");
  if (!status) return;
  if (status->ntp != ntp_ || !status->trouble.empty()) ask_for_ntp();
  follow_ntp();
}

void ClockSetting::ask_for_ntp() {
  const bool has_been = ntp_asked_at_ != loop::Instant{};
  if (has_been && loop_.now() < ntp_asked_at_ + kAskAgain) return;
  ntp_asked_at_ = loop_.now();
  host::log_failure(host::Level::Error, "cannot request NTP", adit_clock_.submit(clock::kNtpFile, ntp_));
}

/// Offers the time until adit-clock has set it. Then chronyd keeps the clock by itself.
void ClockSetting::follow_ntp() {
  const auto status = adit_clock_.status();
  const auto behind = watch_.offset();
  if (!status || !behind || status->trusted_source() == clock::Source::Ntp) return;
  on_offered({clock::Source::Ntp, loop_.wall_now() - loop_.wall_offset() + *behind});
}

bool ClockSetting::is_kept_by_ntp() const {
  const auto status = adit_clock_.status();
  return status && status->trusted_source() == clock::Source::Ntp && watch_.offset();
}

std::string ClockSetting::ntp_trouble() const {
  if (!ntp_.is_on()) return "";
  const auto status = adit_clock_.status();
  if (adit_clock_.is_starting()) return "";
  if (!status && adit_clock_.runs_here()) return adit_clock_.status_error();
  if (!status) return "the settings ask for NTP, but Adit does not set the clock of this machine";
  if (status->ntp == ntp_ && !status->trouble.empty()) return status->trouble;
  if (ntp_.server.empty() || watch_.offset() || loop_.now() < ntp_since_ + kFirstAnswer) return "";
  return icd::sentence(
      "the NTP server ", ntp_.server, " does not answer",
      status->trusted_source() == clock::Source::Ntp ? ", or its time is off by more than a minute" : "");
}

std::string ClockSetting::ntp_text() const {
  if (auto trouble = ntp_trouble(); !trouble.empty()) return trouble;
  std::string said;
  if (!ntp_.server.empty())
    said = icd::sentence("the NTP server ", ntp_.server,
                         is_kept_by_ntp() ? " keeps the time" : " is being asked");
  if (ntp_.clients.empty()) return said;
  if (!said.empty()) said += "; ";
  const auto status = adit_clock_.status();
  return said +
         (status && clock::is_set(status->source) ? "NTP gives the time to "
                                                  : "once the time is set, NTP gives it to ") +
         ntp_.clients;
}

}  // namespace adit::admin
