#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "simulation/http.hpp"

namespace adit::simulation {

/// Event::who of an answer that is an HTML page.
inline constexpr const char* kForeign = "foreign";
/// Event::who of a redirect to the same path with or without a slash at its end.
inline constexpr const char* kOtherForm = "other form";
/// Event::who of an answer longer than any Command Post's. Only its head is read.
inline constexpr const char* kTooLong = "too long";

/// Turns the bytes between Adit and the Command Post on one connection into events of the history.
class UpstreamView {
 public:
  UpstreamView(int place, std::uint64_t connection) : place_(place), connection_(connection) {}
  void left(std::string_view bytes);
  void came(std::string_view bytes);

 private:
  const int place_;  // index of the Command Post
  const std::uint64_t connection_;
  HttpStream requests_, answers_;
  std::string path_;
};

}  // namespace adit::simulation
