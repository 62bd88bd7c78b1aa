#include "body.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  adit::fuzz::try_body(adit::codec::Format::Json, {data, size});
  return 0;
}
