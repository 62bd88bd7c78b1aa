// Preloaded into aditd by `loop`: writes the CPU milliseconds of each step of the main thread, from one wait
// of its event loop to the next, into the file that ADIT_STEPS names, a line each. Steps below half a
// millisecond are left out.
#include <dlfcn.h>
#include <sys/epoll.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace {

double cpu_ms() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) / 1e6;
}

double began = -1;

void step_ends() {
  static std::FILE* const file = std::fopen(std::getenv("ADIT_STEPS"), "a");
  constexpr double kLeast = 0.5;
  const double took = cpu_ms() - began;
  if (file == nullptr || began < 0 || took < kLeast) return;
  std::fprintf(file, "%.2f\n", took);
  std::fflush(file);
}

/// `wait` is what it does between two steps.
template <class Wait>
auto between_steps(Wait wait) {
  if (getpid() != gettid()) return wait();
  step_ends();
  const auto result = wait();
  began = cpu_ms();
  return result;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

extern "C" int epoll_wait(int fd, epoll_event* events, int most, int timeout) {
  static auto* const real = next<int(int, epoll_event*, int, int)>("epoll_wait");
  return between_steps([&] { return real(fd, events, most, timeout); });
}

/// sd-event waits by epoll_pwait2 where it can, which it calls so.
extern "C" long syscall(long number, ...) {
  static auto* const real = next<long(long, ...)>("syscall");
  std::array<long, 6> with{};
  va_list list;
  va_start(list, number);
  for (long& each : with) each = va_arg(list, long);
  va_end(list);
  const auto call = [&] { return real(number, with[0], with[1], with[2], with[3], with[4], with[5]); };
  return number == SYS_epoll_pwait2 ? between_steps(call) : call();
}
