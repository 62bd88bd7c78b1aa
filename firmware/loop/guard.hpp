#pragma once

#include <cstdint>
#include <exception>

namespace adit::loop {

/// Notes an exception that got as far as the edge of the program: counted, and told to whoever asked to be
/// told, else to stderr. Thread-safe. `where`: what ended by it, as in "a job of a worker".
void caught(const char* where, const char* what) noexcept;

/// How many were caught since the program began.
std::uint64_t caught_so_far() noexcept;

/// Who is told of them from now on; called on the thread that caught it, and may throw.
void tell_of_caught(void (*told)(const char* where, const char* what)) noexcept;

/// From now on an exception of a loop's callback or of a noexcept function ends the process with status 1,
/// after a line on stderr. Accepted messages are on the disk, and the next start reads them.
void end_by_uncaught() noexcept;

/// From now on each end of the process by such an exception, or by a signal of its own fault (SIGSEGV,
/// SIGABRT and others), adds a byte to this file.
void count_faults(const char* file) noexcept;

/// Calls `work`; an exception, whichever library it is from, ends `work` and nothing else. False: it did.
/// Requests and jobs of workers go through here, so that each of them fails alone.
template <class Work>
bool guarded(const char* where, Work&& work) noexcept {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    caught(where, error.what());
  } catch (...) {
    caught(where, "unknown exception");
  }
  return false;
}

}  // namespace adit::loop
