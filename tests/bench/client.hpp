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

/// What is posted, again and again.
enum class Kind : std::uint8_t {
  Reports,  // POST /api/artifact_reports: no two alike, each lies 10 m from all others
  States,   // POST /state/update: ten robots' poses as Python writes them, 1.4 KB; no two alike
};

/// The message of that number.
std::string body_of(Kind kind, std::uint64_t number);

/// A client of the ICD on one kept-alive connection over loopback, with as little of its own time in what it
/// measures as there can be.
class Client {
 public:
  static std::expected<Client, std::string> connect(std::uint16_t port, const std::string& token, Kind kind);

  /// Posts one message and gives the time from the first byte's sending to the last byte of its answer. An
  /// error where that is not the 201 that belongs to this report, or the 200 of a state.
  std::expected<Clock::duration, std::string> post(std::uint64_t number);

 private:
  Client(loop::FileDescriptor fd, std::string head, Kind kind)
      : fd_(std::move(fd)), head_(std::move(head)), kind_(kind) {}
  bool is_answered(std::string_view answer, std::uint64_t number) const;
  std::expected<std::string, std::string> answer();

  loop::FileDescriptor fd_;
  std::string head_;  // of each request, up to Content-Length
  Kind kind_;
};

}  // namespace adit::bench
