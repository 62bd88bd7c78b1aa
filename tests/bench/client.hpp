#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <string>
#include <string_view>

#include "loop/file_descriptor.hpp"

namespace adit::bench {

using Clock = std::chrono::steady_clock;

/// With what errno says.
std::unexpected<std::string> system_error(std::string_view doing);

/// An artifact report that no other report of the run is like: every one lies 10 m from all others.
std::string report_body(std::uint64_t number);

/// A client of the ICD on one kept-alive connection over loopback, with as little of its own time in what it
/// measures as there can be.
class Client {
 public:
  static std::expected<Client, std::string> connect(std::uint16_t port, const std::string& token);

  /// Posts one report and gives the time from the first byte's sending to the last byte of its answer. An
  /// error where that is not the 201 that belongs to this report.
  std::expected<Clock::duration, std::string> report(std::uint64_t number);

 private:
  Client(loop::FileDescriptor fd, std::string head) : fd_(std::move(fd)), head_(std::move(head)) {}
  std::expected<std::string, std::string> answer();

  loop::FileDescriptor fd_;
  std::string head_;  // of each request, up to Content-Length
};

}  // namespace adit::bench
