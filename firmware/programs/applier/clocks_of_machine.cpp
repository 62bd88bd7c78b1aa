// The clocks that adit-clock sets: the system clock and a battery clock.
#include <fcntl.h>
#include <linux/rtc.h>
#include <sys/ioctl.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <ctime>

#include "applier/clock_setter.hpp"
#include "host/log.hpp"
#include "host/service.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::applier {
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
    host::log(host::Level::Warning, "cannot set the battery-backed clock", {{"why", std::strerror(errno)}});
}

}  // namespace

Clocks clocks_of_machine(const std::string& chip_device) {
  return {.wall = [] { return time_of(CLOCK_REALTIME); },
          .monotonic = [] { return time_of(CLOCK_MONOTONIC); },
          .set = [chip_device](double now) -> std::expected<void, std::string> {
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
