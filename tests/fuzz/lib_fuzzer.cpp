// Under libFuzzer the target is named by ADIT_FUZZ_TARGET.
#include <cstdlib>

#include "targets.hpp"

namespace {

const adit::fuzz::Target& target_in_environment() {
  const char* const name = std::getenv("ADIT_FUZZ_TARGET");
  const auto* const target = adit::fuzz::target_named(name == nullptr ? "" : name);
  if (target != nullptr) return *target;
  std::fprintf(stderr, "ADIT_FUZZ_TARGET names none of the targets: tests/fuzz/run does\n");
  std::exit(1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  static const adit::fuzz::Target& target = target_in_environment();
  target.try_input({reinterpret_cast<const char*>(bytes), size});
  return 0;
}
