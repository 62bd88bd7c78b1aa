#pragma once

#include <cstdint>
#include <exception>

#include "loop/file_descriptor.hpp"

namespace adit::loop {

/// Counts an exception that nobody handled, and reports it to the function of set_exception_logger(), or to
/// stderr without one or if it throws. `where`: the aborted work, as in "a job of a worker". Thread-safe.
void log_exception(const char* where, const char* what) noexcept;

/// The number of calls of log_exception() since the process start. Thread-safe.
std::uint64_t exception_count() noexcept;

/// Sets the reporter of such exceptions, called on their thread. It may throw. Null: stderr. Thread-safe.
void set_exception_logger(void (*told)(const char* where, const char* what)) noexcept;

/// From now on an exception that leaves a callback of the loop or a noexcept function ends the process with
/// status 1, after a line on stderr. Accepted messages are on disk, and the next start reads them.
void end_by_uncaught() noexcept;

/// From now on each such end, and each end by SIGSEGV, SIGBUS, SIGILL, SIGFPE or SIGABRT, appends a byte to
/// `file`, or to the file of the thread's FaultCounter. Errno: `file` cannot be opened, and ends are not
/// counted. 0: they are.
int count_faults(const char* file) noexcept;

/// While it exists, faults of its thread count in another file (count_faults()). One at a time per thread.
class FaultCounter {
 public:
  /// If `file` does not exist, faults of this thread are counted as before.
  explicit FaultCounter(const char* file) noexcept;
  ~FaultCounter();
  FaultCounter(const FaultCounter&) = delete;
  FaultCounter& operator=(const FaultCounter&) = delete;

 private:
  FileDescriptor file_;
};

/// Calls `work`. If `work` throws, reports that by log_exception() and returns false. Requests and jobs of
/// workers are called by run_guarded(), so that each fails alone.
template <class Work>
bool run_guarded(const char* where, Work&& work) noexcept {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    log_exception(where, error.what());
  } catch (...) {
    log_exception(where, "unknown exception");
  }
  return false;
}

}  // namespace adit::loop
