#include "admin/clock_setting.hpp"

#include <unistd.h>

#include "admin/network_requests.hpp"
#include "admin/refuse.hpp"
#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::admin {

api::ClockView ClockSetting::clock() const {
  api::ClockView view{
      .now = loop_.wall_now(), .managed = status_.has_value(), .why = {}, .refusal = not_taken_up_};
  if (!status_) {
    view.why = "adit-clock does not run here: " + status_.error();
    view.is_set = view.now >= clock::kEarliest;
    return view;
  }
  view.source = status_->source;
  view.is_set = clock::is_set(status_->source);
  if (asked_.empty() && view.refusal.empty()) view.refusal = status_->refusal;
  return view;
}

std::optional<bool> ClockSetting::is_set() const {
  if (status_) return clock::is_set(status_->source);
  return loop_.wall_now() < clock::kEarliest ? std::optional(false) : std::nullopt;
}

icd::Checked<void> ClockSetting::set_clock(double time) {
  if (!status_) return refuse(icd::Status::Conflict, clock().why);
  if (!clock::to_be_set(status_->source, {clock::Source::Operator, time}, loop_.wall_now()))
    return refuse(icd::Status::UnprocessableEntity, "time: expected seconds since 1970, from 2026 to 2099");
  if (const auto asked = ask(clock::Source::Operator, time); !asked)
    return refuse(icd::Status::ServiceUnavailable, asked.error());
  return {};
}

void ClockSetting::offered(const clock::Offer& offer) {
  if (!status_ || !asked_.empty() || !not_taken_up_.empty()) return;
  if (!status_->refusal.empty()) return;  // it would be again; the operator may insist
  const double of_the_system = loop_.wall_now() - loop_.wall_ahead();
  const auto time = clock::to_be_set(status_->source, offer, of_the_system);
  if (!time) return;
  if (const auto asked = ask(offer.source, *time); !asked) not_taken_up_ = asked.error();
}

std::expected<void, std::string> ClockSetting::ask(clock::Source source, double time) {
  const clock::Request request{.nonce = NetworkRequests::draw_nonce(),
                               .source = source,
                               .time = time,
                               .at = std::chrono::duration<double>(loop_.now().time_since_epoch()).count()};
  auto written = host::write_file(request_, clock::write(request), host::kOursAlone);
  if (!written) return written;
  asked_ = request.nonce;
  asked_at_ = loop_.now();
  not_taken_up_.clear();
  return {};
}

void ClockSetting::every_second() {
  const auto text = host::read_file(status_file_);
  status_ = text ? clock::read<clock::Status>(*text) : std::unexpected(text.error());
  if (status_ && status_->nonce == asked_) asked_.clear();
  if (!asked_.empty() && loop_.now() >= asked_at_ + kTakenUpWithin) give_up();
}

void ClockSetting::give_up() {
  unlink(request_.c_str());
  asked_.clear();
  not_taken_up_ = "adit-clock did not take it up: see journalctl -u adit-clock";
  host::log(host::Level::Error, "the clock was not set by adit-clock");
}

}  // namespace adit::admin
