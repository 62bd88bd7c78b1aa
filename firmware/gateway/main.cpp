/// aditd.

#include <span>

#include "gateway/options.hpp"
#include "gateway/service.hpp"
#include "gateway/version.hpp"
#include "host/command_line.hpp"
#include "host/log.hpp"
#include "loop/guard.hpp"

int main(int argc, char** argv) {
  const auto options =
      adit::gateway::parse_options(std::span<char* const>(argv + 1, static_cast<std::size_t>(argc - 1)));
  if (const auto exit =
          adit::host::answered("aditd", adit::gateway::kVersion, adit::gateway::kUsage, options))
    return *exit;
  adit::loop::tell_of_caught([](const char* where, const char* what) {
    adit::host::log(adit::host::Level::Error, "an exception ended what it came from",
                    {{"what", where}, {"why", what}});
  });
  int exit = 1;
  adit::loop::guarded("the service", [&] { exit = adit::gateway::Service(*options).run(); });
  return exit;
}
