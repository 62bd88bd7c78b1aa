#include "host/output.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "host/log.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::host {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kMostTold = 512;

struct Pipe {
  loop::FileDescriptor from, to;
};

std::optional<Pipe> make_pipe() {
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return std::nullopt;
  return Pipe{loop::FileDescriptor(ends[0]), loop::FileDescriptor(ends[1])};
}

std::vector<std::string> clean_environment() {
  std::vector<std::string> clean = {"LC_ALL=C"};
  for (const char* name : {"PATH", "DBUS_SYSTEM_BUS_ADDRESS"}) {
    if (const char* value = std::getenv(name)) clean.push_back(std::string(name) + '=' + value);
  }
  return clean;
}

/// For execve(2). `texts` must outlive the result.
std::vector<char*> pointers_to(const std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  pointers.reserve(texts.size() + 1);
  for (const std::string& text : texts) pointers.push_back(const_cast<char*>(text.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

/// Starts a program without input and with these two outputs. Returns its PID, or errno.
std::expected<pid_t, int> spawn(const std::vector<std::string>& words, int output, int errors,
                                const std::vector<std::string>& environment) {
  const auto arguments = pointers_to(words);
  const auto variables = pointers_to(environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);  // the loop's signals are blocked in this process
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t process = 0;
  const int error =
      posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), variables.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return std::unexpected(error);
  return process;
}

/// "" for exit status 0, else "exit status 3" or "ended by signal 9".
std::string await_end(pid_t process) {
  int status = 0;
  while (waitpid(process, &status, 0) < 0) {
    if (errno != EINTR) return std::string("the exit status is unknown: ") + std::strerror(errno);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  return WIFEXITED(status) ? "exit status " + std::to_string(WEXITSTATUS(status))
                           : "ended by signal " + std::to_string(WTERMSIG(status));
}

/// The reading end of one output.
class PipeReader {
 public:
  PipeReader(int fd, std::string& heard) : fd_(fd), heard_(heard) {}
  int fd() const { return over_ ? -1 : fd_; }  // poll(2) ignores -1
  bool is_at_end() const { return over_; }

  void read() {
    char buffer[4096];
    const ssize_t size = ::read(fd_, buffer, sizeof buffer);
    if (size < 0 && errno == EINTR) return;
    over_ = size <= 0;
    if (over_) return;
    heard_.append(buffer, static_cast<std::size_t>(size));
    if (heard_.size() <= Output::kMostKept) return;
    const std::size_t surplus = heard_.size() - Output::kMostKept;
    heard_.erase(0, surplus);
    told_ -= std::min(told_, surplus);
  }
  /// Reports whole lines that have not been reported.
  void emit_lines(const std::function<void(std::string_view)>& line) {
    for (std::size_t end; (end = heard_.find('\n', told_)) != std::string::npos; told_ = end + 1) {
      if (line) line(std::string_view(heard_).substr(told_, end - told_));
    }
  }

 private:
  int fd_;
  std::string& heard_;
  std::size_t told_ = 0;
  bool over_ = false;
};

/// Reads both outputs to their ends. False: not by `until`.
bool read_outputs(PipeReader& out, PipeReader& err, Clock::time_point until,
                  const std::function<void(std::string_view)>& line) {
  while (!out.is_at_end() || !err.is_at_end()) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd ready[] = {{out.fd(), POLLIN, 0}, {err.fd(), POLLIN, 0}};
    const int count = left > 0 ? poll(ready, 2, static_cast<int>(left)) : 0;
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    if (ready[0].revents != 0) {
      out.read();
      out.emit_lines(line);
    }
    if (ready[1].revents != 0) err.read();
  }
  return true;
}

}  // namespace

Output output_of(const std::vector<std::string>& words, std::chrono::milliseconds within,
                 const std::function<void(std::string_view)>& line) {
  Output output;
  auto out = make_pipe(), err = make_pipe();
  const auto environment = clean_environment();
  const auto process = out && err ? spawn(words, out->to.get(), err->to.get(), environment)
                                  : std::expected<pid_t, int>(std::unexpected(errno));
  if (!process) {
    output.trouble = std::strerror(process.error());
    return output;
  }
  out->to = loop::FileDescriptor();
  err->to = loop::FileDescriptor();
  PipeReader outs(out->from.get(), output.out), errs(err->from.get(), output.err);
  const bool in_time = read_outputs(outs, errs, Clock::now() + within, line);
  if (!in_time) kill(*process, SIGKILL);
  output.trouble = await_end(*process);
  if (!in_time) output.trouble = "took longer than " + std::to_string(within.count()) + " ms";
  return output;
}

std::expected<void, std::string> run_command(const std::vector<std::string>& words,
                                             std::chrono::milliseconds within) {
  const Output output = output_of(words, within);
  if (output.trouble.empty()) return {};
  std::string sentence;
  for (const std::string& word : words) sentence += word + (&word == &words.back() ? ": " : " ");
  const std::string& said = output.err.empty() ? output.out : output.err;
  if (said.empty()) return std::unexpected(sentence + output.trouble);
  const std::string first = said.substr(0, std::min(said.find('\n'), kMostTold));
  return std::unexpected(sentence + escape(first) + " (" + output.trouble + ')');
}

}  // namespace adit::host
