#include "host/random.hpp"

#include <unistd.h>

#include <cstdlib>

#include "host/log.hpp"
#include "icd/require.hpp"

namespace adit::host {

void fill_random(std::span<std::uint8_t> bytes) {
  icd::require(bytes.size() <= 256);  // reads up to this size cannot fail after boot (getentropy(3))
  if (getentropy(bytes.data(), bytes.size()) == 0) return;
  log(Level::Error, "no random bytes from the kernel");
  std::abort();
}

}  // namespace adit::host
