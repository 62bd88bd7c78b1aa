#include "applier/clock_setter.hpp"

#include <charconv>
#include <cmath>

#include "host/log.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::applier {
namespace {

using host::Level;

constexpr double kAgrees = 5;  // seconds

/// Whether the battery clock, as the kernel read it at boot, agrees with the system clock and is not earlier
/// than clock::kEarliest.
bool agrees(const std::string& chip, double now) {
  const auto text = host::read_file(chip + "/since_epoch");
  double told = 0;
  if (text) std::from_chars(text->data(), text->data() + text->size(), told);
  return told >= clock::kEarliest && told < clock::kLatest && std::abs(told - now) < kAgrees;
}

}  // namespace

std::expected<void, std::string> ClockSetter::work() {
  if (const auto before = file_.told<clock::Status>()) {
    status_ = *before;
  } else if (agrees(options_.chip, clocks_.wall())) {
    status_.source = clock::Source::Chip;
  }
  status_.boot = clocks_.boot;
  (void)ADIT_TRY(file_.tell(status_));
  auto folder = ADIT_TRY(host::open_requests(options_.wanted));
  while (folder) {
    const auto ntp = ADIT_TRY(host::take_request<clock::Ntp>(*folder, clock::kNtpFile));
    if (ntp) status_.ntp = *ntp;
    const auto time = ADIT_TRY(host::take_request<clock::Request>(*folder, clock::kRequestFile));
    if (time) answer(*time);
    if (!ntp && !time) break;
    status_.trouble = chronyd_.run_with(status_.ntp, status_.trusted());
    (void)file_.tell(status_);
  }
  return {};
}

void ClockSetter::answer(const clock::Request& request) {
  const double at = clocks_.monotonic(), before = clocks_.wall();
  const double time = request.time + (at - request.at);
  status_.nonce = request.nonce;
  status_.refusal = clock::hindrance(request, at, status_);
  if (status_.refusal.empty()) {
    const auto set = clocks_.set(time);
    status_.refusal = set ? "" : "cannot set the clock: " + set.error();
  }
  if (status_.refusal.empty()) {
    status_.source = request.source;
    if (request.source == clock::Source::Ntp) status_.server = request.server;
    // A guessed time is not stored, because the next boot trusts the battery clock more than the Command
    // Post.
    if (clock::is_set(request.source)) clocks_.set_chip(time);
    host::log(Level::Notice, "clock set",
              {{"by", std::string(clock::kSourceWords[static_cast<std::size_t>(request.source)])},
               {"ahead_by_s", icd::sentence(time - before)}});
  } else {
    host::log(Level::Warning, "request rejected", {{"why", status_.refusal}});
  }
}

}  // namespace adit::applier
