// Replaces malloc(3) and its relatives to measure the memory of aditd.
#include "simulation/heap.hpp"

#include <malloc.h>

#include <algorithm>
#include <utility>

extern "C" {  // glibc's internal names
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
}

namespace {

std::size_t the_most = 0;

[[maybe_unused]] void is_wanted(std::size_t size) {
  the_most = std::max(the_most, size);
}

}  // namespace

namespace adit::simulation {

std::size_t heap() {
  const auto info = ::mallinfo2();
  return info.uordblks + info.hblkhd;
}

std::size_t most_wanted() {
  return std::exchange(the_most, 0);
}

}  // namespace adit::simulation

#ifndef ADIT_SANITIZED  // a sanitizer has its own heap
extern "C" {

void* malloc(std::size_t size) {
  is_wanted(size);
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  is_wanted(count * size);
  return __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) {
  is_wanted(size);
  return __libc_realloc(old, size);
}

}  // extern "C"
#endif
