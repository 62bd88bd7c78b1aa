#pragma once

#include <cstdint>
#include <string>

namespace adit::host {

/// Resources of this process, as the kernel counts them.
struct Process {
  double age_seconds = 0;  // since its start
  double cpu_seconds = 0;  // user and system time of all threads
  std::uint64_t resident_bytes = 0, open_files = 0, most_files = 0, threads = 0;
};
Process process();

/// "Linux 6.1.0 aarch64"
std::string kernel();

/// The device tree's name of the machine ("Raspberry Pi Compute Module 4"), or "".
std::string model();

}  // namespace adit::host
