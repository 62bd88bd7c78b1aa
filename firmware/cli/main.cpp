#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <vector>

#include "cli/command.hpp"
#include "loop/guard.hpp"

int main(int count, char** arguments) {
  adit::loop::tell_of_caught(
      [](const char*, const char* what) { std::fprintf(stderr, "adit: cannot go on: %s\n", what); });
  const std::vector<std::string_view> words(arguments + 1, arguments + count);
  const bool colour = isatty(STDOUT_FILENO) == 1 && std::getenv("NO_COLOR") == nullptr;
  bool printed = true;
  const auto print = [&printed](const std::string& text) {
    printed = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fflush(stdout) == 0 &&
              printed;
  };
  adit::cli::Outcome outcome{adit::cli::Exit::Unable, "", ""};
  adit::loop::guarded("adit", [&] { outcome = adit::cli::run(words, colour, print); });
  std::fputs(outcome.err.c_str(), stderr);
  print(outcome.out);
  return static_cast<int>(printed ? outcome.exit : adit::cli::Exit::Unable);
}
