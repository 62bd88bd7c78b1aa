#include "host/process.hpp"

#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <sstream>

#include "host/files.hpp"

namespace adit::host {
namespace {

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) / 1e6;
}

std::uint64_t count_in(const char* folder) {
  std::error_code error;
  std::uint64_t count = 0;
  for (std::filesystem::directory_iterator each(folder, error), end; !error && each != end;
       each.increment(error)) {
    ++count;
  }
  return count;
}

/// Resident pages, the second number of proc_pid_statm(5).
std::uint64_t resident_pages() {
  const auto file = slurp("/proc/self/statm");
  std::uint64_t size = 0, resident = 0;
  if (file) std::istringstream(file->text) >> size >> resident;
  return resident;
}

const auto kBegan = std::chrono::steady_clock::now();  // before main()

}  // namespace

Process process() {
  Process process;
  process.age_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - kBegan).count();
  rusage usage{};
  if (getrusage(RUSAGE_SELF, &usage) == 0) {
    process.cpu_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }
  process.resident_bytes = resident_pages() * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  process.open_files = count_in("/proc/self/fd");
  process.threads = count_in("/proc/self/task");
  rlimit limit{};
  if (getrlimit(RLIMIT_NOFILE, &limit) == 0) process.most_files = limit.rlim_cur;
  return process;
}

std::string kernel() {
  utsname name{};
  if (uname(&name) != 0) return "";
  return std::string(name.sysname) + " " + name.release + " " + name.machine;
}

/// The service's ProcSubset=pid hides /proc/device-tree, a link to this directory.
std::string model() {
  const auto file = slurp("/sys/firmware/devicetree/base/model");
  return file ? file->text.substr(0, file->text.find('\0')) : "";
}

}  // namespace adit::host
