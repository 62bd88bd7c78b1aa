#include "admin/clock_setting.hpp"

#include <unistd.h>

#include "admin/nonce.hpp"
#include "admin/refuse.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"

namespace adit::admin {
namespace {

/// chronyd asks four times in six seconds as it starts.
constexpr std::chrono::seconds kFirstAnswer{30};

}  // namespace

api::ClockView ClockSetting::clock() const {
  api::ClockView view{
      .now = loop_.wall_now(), .managed = status_.has_value(), .why = {}, .refusal = not_taken_up_};
  view.ntp = ntp_said();
  view.is_kept = is_kept_by_ntp();
  if (!status_) {
    view.why = "adit-clock does not run here: " + status_.error();
    view.is_set = view.now >= clock::kEarliest;
    return view;
  }
  view.source = status_->source;
  view.is_set = clock::is_set(status_->source);
  if (!waits_ && view.refusal.empty()) view.refusal = status_->refusal;
  return view;
}

std::optional<bool> ClockSetting::is_set() const {
  if (status_) return clock::is_set(status_->source);
  return loop_.wall_now() < clock::kEarliest ? std::optional(false) : std::nullopt;
}

icd::Checked<void> ClockSetting::set_clock(double time) {
  if (!status_) return refuse(icd::Status::Conflict, clock().why);
  if (is_kept_by_ntp())
    return refuse(icd::Status::Conflict, icd::sentence("the NTP server ", ntp_.server,
                                                       " keeps the time: clock.ntp_server in the settings"));
  if (!clock::to_be_set(status_->source, {clock::Source::Operator, time}, loop_.wall_now()))
    return refuse(icd::Status::UnprocessableEntity, "time: expected seconds since 1970, from 2026 to 2099");
  if (const auto asked = ask(clock::Source::Operator, time); !asked)
    return refuse(icd::Status::ServiceUnavailable, asked.error());
  return {};
}

void ClockSetting::offered(const clock::Offer& offer) {
  if (!status_ || waits_) return;
  const bool came_to_nothing = !not_taken_up_.empty() || !status_->refusal.empty();
  if (came_to_nothing && loop_.now() < asked_at_ + kAskAgain) return;  // the operator may insist
  const double of_the_system = loop_.wall_now() - loop_.wall_ahead();
  const auto time = clock::to_be_set(status_->trusted(), offer, of_the_system);
  if (!time) return;
  if (const auto asked = ask(offer.source, *time); !asked) not_taken_up_ = asked.error();
}

std::expected<void, std::string> ClockSetting::ask(clock::Source source, double time) {
  const clock::Request request{.nonce = draw_nonce(),
                               .source = source,
                               .time = time,
                               .at = std::chrono::duration<double>(loop_.now().time_since_epoch()).count(),
                               .boot = status_ ? status_->boot : "",
                               .server = source == clock::Source::Ntp ? ntp_.server : ""};
  auto written = host::write_file(request_, clock::write(request), host::kOursAlone);
  if (!written) return written;
  asked_ = request.nonce;
  waits_ = true;
  asked_at_ = loop_.now();
  not_taken_up_.clear();
  return {};
}

void ClockSetting::every_second(const clock::Ntp& ntp) {
  const auto text = host::read_file(status_file_);
  status_ = text ? clock::read<clock::Status>(*text) : std::unexpected(text.error());
  note_what_became_of_it();
  if (waits_ && loop_.now() >= asked_at_ + kTakenUpWithin) give_up();
  if (ntp_ != ntp || ntp_since_ == loop::Instant{}) ntp_since_ = loop_.now();
  if (std::exchange(ntp_, ntp) != ntp) ntp_asked_at_ = {};
  watch_.every_second(status_ ? ntp_.server : "");
  if (!status_) return;
  if (status_->ntp != ntp_ || !status_->trouble.empty()) ask_for_ntp();
  follow_ntp();
}

void ClockSetting::ask_for_ntp() {
  const bool has_been = ntp_asked_at_ != loop::Instant{};
  if (has_been && loop_.now() < ntp_asked_at_ + kAskAgain) return;
  ntp_asked_at_ = loop_.now();
  const auto written = host::write_file(ntp_request_, clock::write(ntp_), host::kOursAlone);
  if (!written) host::log(host::Level::Error, "cannot request NTP", {{"why", written.error()}});
}

/// Once its time is set, chronyd keeps it by itself.
void ClockSetting::follow_ntp() {
  const auto behind = watch_.behind();
  if (!behind || status_->trusted() == clock::Source::Ntp) return;
  offered({clock::Source::Ntp, loop_.wall_now() - loop_.wall_ahead() + *behind});
}

bool ClockSetting::is_kept_by_ntp() const {
  return status_ && status_->trusted() == clock::Source::Ntp && watch_.behind();
}

std::string ClockSetting::ntp_trouble() const {
  if (!ntp_.is_on()) return "";
  if (!status_) return "the settings ask for NTP, but Adit does not set the clock of this machine";
  if (status_->ntp == ntp_ && !status_->trouble.empty()) return status_->trouble;
  if (ntp_.server.empty() || watch_.behind() || loop_.now() < ntp_since_ + kFirstAnswer) return "";
  return icd::sentence(
      "the NTP server ", ntp_.server, " does not answer",
      status_->trusted() == clock::Source::Ntp ? ", or its time is off by more than a minute" : "");
}

std::string ClockSetting::ntp_said() const {
  if (auto trouble = ntp_trouble(); !trouble.empty()) return trouble;
  std::string said;
  if (!ntp_.server.empty())
    said = icd::sentence("the NTP server ", ntp_.server,
                         is_kept_by_ntp() ? " keeps the time" : " is being asked");
  if (ntp_.clients.empty()) return said;
  if (!said.empty()) said += "; ";
  return said +
         (status_ && clock::is_set(status_->source) ? "NTP gives the time to "
                                                    : "once the time is set, NTP gives it to ") +
         ntp_.clients;
}

/// It may also come after it was given up.
void ClockSetting::note_what_became_of_it() {
  if (!status_ || asked_.empty() || status_->nonce != asked_) return;
  waits_ = false;
  not_taken_up_.clear();
}

void ClockSetting::give_up() {
  unlink(request_.c_str());
  waits_ = false;
  not_taken_up_ = "adit-clock did not read the request: see journalctl -u adit-clock";
  host::log(host::Level::Error, "adit-clock did not set the clock");
}

}  // namespace adit::admin
