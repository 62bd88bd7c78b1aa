#include "applier/clock_setter.hpp"

#include <fcntl.h>
#include <linux/rtc.h>
#include <sys/ioctl.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstring>
#include <ctime>
#include <utility>

#include "host/log.hpp"
#include "host/output.hpp"
#include "host/service.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::applier {
namespace {

using host::Level;

constexpr const char* kUnit = "adit-ntp.service";
constexpr std::chrono::seconds kUnitAnswer{20};

std::array<std::pair<const char*, const std::string*>, 3> files_of(const clock::Chrony& chrony) {
  return {{{clock::kOptionsFile, &chrony.options},
           {clock::kFirewallFile, &chrony.firewall},
           {clock::kConfigurationFile, &chrony.configuration}}};  // last: marks the others complete
}

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

std::string Chronyd::run_with(const clock::Ntp& ntp, clock::Source source) const {
  return ntp.is_on() ? start(clock::chrony_for(ntp, source, interface_)) : stop();
}

std::string Chronyd::start(const clock::Chrony& chrony) const {
  bool is_as_it_was = true;
  for (const auto& [name, text] : files_of(chrony))
    is_as_it_was = is_as_it_was && host::read_file(path(name)) == *text;
  if (is_as_it_was) return "";
  (void)host::remove_file(
      path(clock::kConfigurationFile));  // after a death here, the next request starts chronyd
  for (const auto& [name, text] : files_of(chrony)) {
    if (const auto written = host::write_file(path(name), *text, host::kForAll); !written)
      return written.error();
  }
  const auto started = host::run_command({systemctl_, "restart", kUnit}, kUnitAnswer);
  if (started) {
    host::log(Level::Notice, "NTP is on in the team's network");
    return "";
  }
  (void)host::remove_file(path(clock::kConfigurationFile));
  return "cannot start chronyd: " + started.error();
}

std::string Chronyd::stop() const {
  if (!host::can_exist(path(clock::kConfigurationFile))) return "";
  const auto stopped = host::run_command({systemctl_, "stop", kUnit}, kUnitAnswer);
  if (!stopped) return "cannot stop chronyd: " + stopped.error();
  host::log(Level::Notice, "NTP is off");
  const auto removed = host::remove_file(path(clock::kConfigurationFile));
  return removed ? "" : removed.error();
}

std::expected<void, std::string> ClockSetter::work() {
  if (const auto before = file_.read_earlier<clock::Status>()) {
    status_ = *before;
  } else if (agrees(options_.chip, clocks_.wall())) {
    status_.source = clock::Source::Chip;
  }
  status_.boot = clocks_.boot;
  (void)ADIT_TRY(file_.write(status_));
  auto folder = ADIT_TRY(host::open_requests(options_.wanted));
  while (folder) {
    const auto ntp = ADIT_TRY(host::take_request<clock::Ntp>(*folder, clock::kNtpFile));
    if (ntp) status_.ntp = *ntp;
    const auto time = ADIT_TRY(host::take_request<clock::Request>(*folder, clock::kRequestFile));
    if (time) answer(*time);
    if (!ntp && !time) break;
    status_.trouble = chronyd_.run_with(status_.ntp, status_.trusted_source());
    (void)file_.write(status_);
  }
  return {};
}

void ClockSetter::answer(const clock::Request& request) {
  const double at = clocks_.monotonic(), before = clocks_.wall();
  const double time = request.time + (at - request.at);
  status_.nonce = request.nonce;
  status_.refusal = clock::refusal_reason(request, at, status_);
  if (status_.refusal.empty()) {
    const auto set = clocks_.set(time);
    status_.refusal = set ? "" : "cannot set the clock: " + set.error();
  }
  if (status_.refusal.empty()) {
    status_.source = request.source;
    if (request.source == clock::Source::Ntp) status_.server = request.server;
    // A guess is not stored, because the next boot trusts the battery clock more than the Command Post.
    if (clock::is_set(request.source)) clocks_.set_chip(time);
    host::log(Level::Notice, "clock set",
              {{"by", std::string(clock::kSourceWords[static_cast<std::size_t>(request.source)])},
               {"ahead_by_s", icd::sentence(time - before)}});
  } else {
    host::log(Level::Warning, "request rejected", {{"why", status_.refusal}});
  }
}

namespace {

double time_of(clockid_t clock) {
  timespec time{};
  clock_gettime(clock, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) / 1e9;
}

/// A missing or unsettable clock is ignored, because few boards have one.
void set_chip(const std::string& device, std::time_t now) {
  const loop::FileDescriptor chip(open(device.c_str(), O_RDONLY | O_CLOEXEC));
  if (!chip) return;
  std::tm utc{};
  if (gmtime_r(&now, &utc) == nullptr) return;
  const rtc_time time{.tm_sec = utc.tm_sec,
                      .tm_min = utc.tm_min,
                      .tm_hour = utc.tm_hour,
                      .tm_mday = utc.tm_mday,
                      .tm_mon = utc.tm_mon,
                      .tm_year = utc.tm_year,
                      .tm_wday = 0,
                      .tm_yday = 0,
                      .tm_isdst = 0};
  if (ioctl(chip.get(), RTC_SET_TIME, &time) != 0)
    host::log(Level::Warning, "cannot set the battery-backed clock", {{"why", std::strerror(errno)}});
}

}  // namespace

Clocks clocks_of_machine(const std::string& chip_device) {
  return {.wall = [] { return time_of(CLOCK_REALTIME); },
          .monotonic = [] { return time_of(CLOCK_MONOTONIC); },
          .set = [](double now) -> std::expected<void, std::string> {
            double whole = 0;
            const double rest = std::modf(now, &whole);
            const timespec time{.tv_sec = static_cast<std::time_t>(whole),
                                .tv_nsec = static_cast<long>(rest * 1e9)};
            if (clock_settime(CLOCK_REALTIME, &time) != 0) return std::unexpected(std::strerror(errno));
            return {};
          },
          .set_chip = [chip_device](double now) { set_chip(chip_device, static_cast<std::time_t>(now)); },
          .boot = host::boot()};
}

}  // namespace adit::applier
