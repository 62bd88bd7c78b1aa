#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "cli/command.hpp"

int main(int count, char** arguments) {
  const std::vector<std::string_view> words(arguments + 1, arguments + count);
  const bool colour = isatty(STDOUT_FILENO) == 1 && std::getenv("NO_COLOR") == nullptr;
  const auto outcome = adit::cli::run(words, colour);
  std::fputs(outcome.err.c_str(), stderr);
  const bool printed = std::fwrite(outcome.out.data(), 1, outcome.out.size(), stdout) == outcome.out.size() &&
                       std::fflush(stdout) == 0;
  return static_cast<int>(printed ? outcome.exit : adit::cli::Exit::Unable);
}
