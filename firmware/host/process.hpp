#pragma once

#include <cstdint>
#include <string>

namespace adit::host {

/// What this process uses of the machine, as the kernel counts it.
struct Process {
  double age_seconds = 0;  // since it began
  double cpu_seconds = 0;  // user and system, of all threads
  std::uint64_t resident_bytes = 0, open_files = 0, most_files = 0, threads = 0;
};
Process process();

/// "Linux 6.1.0 aarch64"
std::string kernel();

/// What the device tree calls the machine ("Raspberry Pi Compute Module 4"), or "" where there is none.
std::string model();

}  // namespace adit::host
