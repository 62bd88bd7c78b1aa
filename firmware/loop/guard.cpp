#include "loop/guard.hpp"

#include <atomic>
#include <cstdio>

namespace adit::loop {
namespace {

std::atomic<std::uint64_t> so_far{0};
std::atomic<void (*)(const char*, const char*)> tell{nullptr};

}  // namespace

void caught(const char* where, const char* what) noexcept {
  so_far.fetch_add(1, std::memory_order_relaxed);
  try {
    if (auto* const told = tell.load()) return told(where, what);
  } catch (...) {  // no memory for the log either: stderr needs none
  }
  std::fprintf(stderr, "%s: unhandled exception: %s\n", where, what);
}

std::uint64_t caught_so_far() noexcept {
  return so_far.load(std::memory_order_relaxed);
}

void tell_of_caught(void (*told)(const char* where, const char* what)) noexcept {
  tell.store(told);
}

}  // namespace adit::loop
