#include "loop/file_descriptor.hpp"

#include <unistd.h>

namespace adit::loop {

void close_descriptor(int fd) noexcept {
  ::close(fd);
}

}  // namespace adit::loop
