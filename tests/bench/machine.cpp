#include "machine.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace adit::bench {

std::chrono::nanoseconds cpu_time(pid_t process) {
  std::int64_t sum = 0;
  std::error_code error;
  const std::string tasks = "/proc/" + std::to_string(process) + "/task";
  for (const auto& task : std::filesystem::directory_iterator(tasks, error)) {
    std::int64_t ran = 0;  // the first number: nanoseconds on a CPU (kernel: scheduler/sched-stats)
    std::ifstream(task.path() / "schedstat") >> ran;
    sum += ran;
  }
  return std::chrono::nanoseconds(sum);
}

std::expected<FlushProbe, std::string> FlushProbe::begin(const std::string& folder) {
  const std::string path = folder + "/flush-probe";
  FlushProbe probe(loop::FileDescriptor(::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600)));
  const int fd = probe.fd_.get();
  if (!probe.fd_) return system_error("making " + path);
  ::unlink(path.c_str());
  // Page by page: what is written at once, the kernel caches, and later flushes, in larger pieces.
  constexpr std::array<char, kPage> kZeros{};
  for (off_t page = 0; page < kPages; ++page)
    if (::write(fd, kZeros.data(), kZeros.size()) != kPage) return system_error("filling " + path);
  if (::fsync(fd) != 0) return system_error("flushing " + path);
  return probe;
}

std::expected<Clock::duration, std::string> FlushProbe::write_at(off_t offset) {
  constexpr std::array<char, kBytes> kOnes{1};
  const Clock::time_point began = Clock::now();
  if (::pwrite(fd_.get(), kOnes.data(), kOnes.size(), offset) != kBytes || ::fdatasync(fd_.get()) != 0)
    return system_error("flushing beside the ledger");
  return Clock::now() - began;
}

}  // namespace adit::bench
