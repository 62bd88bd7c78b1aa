
#include <malloc.h>
#include <sys/prctl.h>

#include "box/version.hpp"
#include "command_line/read.hpp"
#include "gateway/options.hpp"
#include "gateway/service.hpp"
#include "host/log.hpp"
#include "icd/chunked_bytes.hpp"
#include "loop/guard.hpp"

int main(int argc, char** argv) {
  using adit::gateway::command_line_of;
  const auto options = adit::command_line::read(command_line_of, {argv + 1, argv + argc});
  if (const auto exit = adit::command_line::answer(command_line_of, adit::box::kVersion, options))
    return *exit;
  ::prctl(PR_SET_NAME, "aditd");  // after exec of /proc/self/exe it is "exe"
  // Each chunk of a map is a mapping, which returns to the system when freed.
  ::mallopt(M_MMAP_THRESHOLD, int{adit::icd::ChunkedBytes::kChunk});
  adit::loop::set_exception_logger([](const char* where, const char* what) {
    adit::host::log(adit::host::Level::Error, "unhandled exception", {{"ended", where}, {"why", what}});
  });
  adit::loop::end_by_uncaught();
  return adit::gateway::Service(*options, argv).run(&adit::loop::count_faults);
}
