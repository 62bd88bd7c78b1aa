#include "scarce_memory.hpp"

#include <cstdlib>
#include <new>

namespace adit {
namespace {

struct Scarcity {
  std::size_t before = 0, left = 0, failed = 0;
};
thread_local Scarcity scarcity;

bool fails() {
  if (scarcity.left == 0) return false;
  if (scarcity.before > 0) {
    --scarcity.before;
    return false;
  }
  --scarcity.left;
  ++scarcity.failed;
  return true;
}

}  // namespace

ScarceMemory::ScarceMemory(std::size_t first, std::size_t count) {
  scarcity = {.before = first, .left = count};
}

std::size_t ScarceMemory::end() {
  scarcity.left = 0;
  return scarcity.failed;
}

std::size_t ScarceMemory::failed() {
  return scarcity.failed;
}

}  // namespace adit

// These stand before the library's own for all of the program. What asks without throwing (std::nothrow)
// copes with having nothing, and is not counted.
void* operator new(std::size_t size) {
  if (adit::fails()) throw std::bad_alloc();
  if (void* const made = std::malloc(size == 0 ? 1 : size)) return made;
  throw std::bad_alloc();
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  return std::malloc(size == 0 ? 1 : size);
}
void operator delete(void* gone) noexcept {
  std::free(gone);
}
void operator delete(void* gone, std::size_t) noexcept {
  std::free(gone);
}
