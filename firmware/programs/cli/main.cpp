#include <langinfo.h>
#include <termios.h>
#include <unistd.h>

#include <clocale>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <string_view>
#include <vector>

#include "cli/commands.hpp"
#include "host/log.hpp"
#include "loop/guard.hpp"

namespace adit::cli {
namespace {

bool is_terminal(int fd) {
  return isatty(fd) == 1;
}

/// Whether the terminal knows escape sequences, by TERM.
bool has_escapes() {
  const char* const term = std::getenv("TERM");
  return term != nullptr && std::string_view(term) != "" && std::string_view(term) != "dumb";
}

/// On other terminals the bytes of a character could be control codes.
bool is_utf8_terminal() {
  return std::setlocale(LC_CTYPE, "") != nullptr && nl_langinfo(CODESET) == std::string_view("UTF-8");
}

/// Asks the user at the terminal.
std::optional<bool> ask(const std::string& question) {
  if (!is_terminal(STDIN_FILENO) || !is_terminal(STDERR_FILENO)) return std::nullopt;
  std::fprintf(stderr, "%s [y/N] ", question.c_str());
  char answer[16];
  if (std::fgets(answer, sizeof answer, stdin) == nullptr) return false;
  const std::string_view said(answer);
  return said == "y\n" || said == "Y\n" || said == "yes\n";
}

termios before_silence;

void end_silence() {
  tcsetattr(STDIN_FILENO, TCSAFLUSH, &before_silence);
}

void on_end_signal(int signal) {
  end_silence();
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

/// Hides typed characters while it lives, and shows them again if a signal ends the program.
class Silence {
 public:
  Silence() : is_terminal_(tcgetattr(STDIN_FILENO, &before_silence) == 0) {
    if (!is_terminal_) return;
    for (const int signal : kSignals) std::signal(signal, on_end_signal);
    termios silent = before_silence;
    silent.c_lflag &= ~static_cast<tcflag_t>(ECHO);
    tcsetattr(STDIN_FILENO, TCSAFLUSH, &silent);
  }
  ~Silence() {
    if (!is_terminal_) return;
    end_silence();
    for (const int signal : kSignals) std::signal(signal, SIG_DFL);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  static constexpr int kSignals[] = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};
  bool is_terminal_;
};

std::optional<std::string> read_secret(const std::string& question) {
  const bool asks = is_terminal(STDIN_FILENO) && is_terminal(STDERR_FILENO);
  if (asks) std::fprintf(stderr, "%s", question.c_str());
  const Silence silence;
  std::string line;
  if (!std::getline(std::cin, line)) return std::nullopt;
  if (asks) std::fprintf(stderr, "\n");
  return line;
}

}  // namespace
}  // namespace adit::cli

int main(int count, char** arguments) {
  using namespace adit::cli;
  adit::loop::set_exception_logger(
      [](const char*, const char* what) { std::fprintf(stderr, "adit: stopped: %s\n", what); });
  const std::vector<std::string_view> words(arguments + 1, arguments + count);
  const bool screen = is_terminal(STDOUT_FILENO) && has_escapes();
  const bool utf8 = is_utf8_terminal();
  bool printed = true;
  const auto write_to = [utf8](std::FILE* file, const std::string& text) {
    const std::string safe = !utf8 && is_terminal(fileno(file)) ? adit::host::to_ascii(text) : text;
    return std::fwrite(safe.data(), 1, safe.size(), file) == safe.size() && std::fflush(file) == 0;
  };
  const Console console{
      .colour = screen && std::getenv("NO_COLOR") == nullptr,
      .screen = screen,
      .print = [&](const std::string& text) { printed = write_to(stdout, text) && printed; },
      .ask = ask,
      .read_secret = read_secret};
  Outcome outcome{Exit::Unable, "", ""};
  adit::loop::run_guarded("adit", [&] { outcome = run(words, console); });
  write_to(stderr, outcome.err);
  console.print(outcome.out);
  return static_cast<int>(printed ? outcome.exit : Exit::Unable);
}
