#pragma once

#include <sys/types.h>

#include <chrono>
#include <expected>
#include <string>

#include "client.hpp"
#include "loop/file_descriptor.hpp"

namespace adit::bench {

/// The CPU time that all threads of a process have had; zero where the kernel does not tell.
std::chrono::nanoseconds cpu_time(pid_t process);

/// A file of its own beside the ledger, gone at the end, to see what a flush costs there.
class FlushProbe {
 public:
  static std::expected<FlushProbe, std::string> begin(const std::string& folder);

  /// Appends 256 bytes and flushes: the file's new size is flushed with them.
  std::expected<Clock::duration, std::string> append() { return write_at(end_ += kBytes); }
  /// The same in place of bytes that are on the disk already.
  std::expected<Clock::duration, std::string> overwrite() { return write_at(next_page() * kPage); }

 private:
  static constexpr off_t kBytes = 256, kPage = 4096, kPages = 256;

  explicit FlushProbe(loop::FileDescriptor fd) : fd_(std::move(fd)) {}
  std::expected<Clock::duration, std::string> write_at(off_t offset);
  off_t next_page() { return page_ = (page_ + 1) % kPages; }

  loop::FileDescriptor fd_;
  off_t page_ = 0;
  off_t end_ = kPages * kPage - kBytes;  // where the last append began
};

}  // namespace adit::bench
