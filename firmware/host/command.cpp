#include "host/command.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "host/log.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::host {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kMostHeard = 512;

/// What comes from `fd` until it ends; false where that takes longer.
bool hear(int fd, Clock::time_point until, std::string& heard) {
  while (true) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(until - Clock::now()).count();
    pollfd ready{fd, POLLIN, 0};
    const int count = left > 0 ? poll(&ready, 1, static_cast<int>(left)) : 0;
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    char buffer[256];
    const ssize_t size = read(fd, buffer, sizeof buffer);
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return true;
    if (heard.size() < kMostHeard) heard.append(buffer, static_cast<std::size_t>(size));
  }
}

std::expected<pid_t, int> start(const std::vector<std::string>& words, int output) {
  std::vector<char*> arguments;
  arguments.reserve(words.size() + 1);
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, output, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);  // the loop's own signals are blocked here
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  pid_t process = 0;
  const int error = posix_spawnp(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return std::unexpected(error);
  return process;
}

std::string first_line(const std::string& text) {
  return escaped(text.substr(0, text.find('\n')));
}

}  // namespace

std::expected<void, std::string> run_command(const std::vector<std::string>& words,
                                             std::chrono::milliseconds within) {
  std::string name;
  for (const std::string& word : words) name += (name.empty() ? "" : " ") + word;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return std::unexpected(name + ": " + std::strerror(errno));
  const loop::FileDescriptor output(ends[0]);
  loop::FileDescriptor input(ends[1]);
  const auto process = start(words, input.get());
  if (!process) return std::unexpected(name + ": " + std::strerror(process.error()));
  input = loop::FileDescriptor();
  std::string heard;
  const bool in_time = hear(output.get(), Clock::now() + within, heard);
  if (!in_time) kill(*process, SIGKILL);
  int status = 0;
  while (waitpid(*process, &status, 0) < 0 && errno == EINTR) {
  }
  if (!in_time) return std::unexpected(name + ": took longer than " + std::to_string(within.count()) + " ms");
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  const std::string end = WIFEXITED(status) ? "exit status " + std::to_string(WEXITSTATUS(status))
                                            : "ended by signal " + std::to_string(WTERMSIG(status));
  return std::unexpected(name + ": " + (heard.empty() ? end : first_line(heard) + " (" + end + ")"));
}

}  // namespace adit::host
