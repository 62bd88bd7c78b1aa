#include "loop/guard.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace adit::loop {
namespace {

std::atomic<std::uint64_t> so_far{0};
std::atomic<void (*)(const char*, const char*)> tell{nullptr};

std::atomic<int> faults_file{-1};
thread_local int file_of_this_thread = -1;

void count_fault() noexcept {
  const int file = file_of_this_thread < 0 ? faults_file.load() : file_of_this_thread;
  [[maybe_unused]] const auto written = ::write(file, "x", 1);
}

}  // namespace

void log_exception(const char* where, const char* what) noexcept {
  so_far.fetch_add(1, std::memory_order_relaxed);
  try {
    if (auto* const told = tell.load()) return told(where, what);
  } catch (...) {  // no memory for the log; stderr needs no memory
  }
  std::fprintf(stderr, "%s: unhandled exception: %s\n", where, what);
}

std::uint64_t exception_count() noexcept {
  return so_far.load(std::memory_order_relaxed);
}

void set_exception_logger(void (*told)(const char* where, const char* what)) noexcept {
  tell.store(told);
}

void end_by_uncaught() noexcept {
  std::set_terminate([] {
    set_exception_logger(nullptr);  // stderr only: this thread may hold the log's lock
    if (const auto thrown = std::current_exception())
      run_guarded("the process", [&] { std::rethrow_exception(thrown); });
    count_fault();
    std::_Exit(1);
  });
}

int count_faults(const char* file) noexcept {
  faults_file.store(::open(file, O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0600));
  if (faults_file.load() < 0) return errno;
  struct sigaction action{};
  action.sa_flags = static_cast<int>(SA_RESETHAND);  // the signal that is raised again ends the process
  action.sa_handler = [](int signal) {
    count_fault();
    (void)::raise(signal);
  };
  for (const int signal : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT})
    (void)::sigaction(signal, &action, nullptr);
  return 0;
}

FaultCounter::FaultCounter(const char* file) noexcept
    : file_(::open(file, O_WRONLY | O_APPEND | O_NOFOLLOW | O_CLOEXEC)) {
  file_of_this_thread = file_.get();
}

FaultCounter::~FaultCounter() {
  file_of_this_thread = -1;
}

}  // namespace adit::loop
