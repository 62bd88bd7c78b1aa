#include "host/command.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "host/log.hpp"
#include "host/spawn.hpp"
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
  const auto process = spawn(words, input.get(), input.get());
  if (!process) return std::unexpected(name + ": " + std::strerror(process.error()));
  input = loop::FileDescriptor();
  std::string heard;
  const bool in_time = hear(output.get(), Clock::now() + within, heard);
  if (!in_time) kill(*process, SIGKILL);
  const std::string end = await_end(*process);
  if (!in_time) return std::unexpected(name + ": took longer than " + std::to_string(within.count()) + " ms");
  if (end.empty()) return {};
  return std::unexpected(name + ": " + (heard.empty() ? end : first_line(heard) + " (" + end + ")"));
}

}  // namespace adit::host
