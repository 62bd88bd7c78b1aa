#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "simulation/http.hpp"

namespace adit::simulation {

/// `who` of an answer that is a page of HTML.
inline constexpr const char* kForeign = "foreign";
/// `who` of one that is longer than any Command Post's: of its head, for the rest is not read.
inline constexpr const char* kTooLong = "too long";

/// What Adit gives a connection to the Command Post, and takes from it, as events of the history.
class UpstreamView {
 public:
  UpstreamView(int place, std::uint64_t connection) : place_(place), connection_(connection) {}
  void left(std::string_view bytes);
  void came(std::string_view bytes);

 private:
  const int place_;  // of the Command Post
  const std::uint64_t connection_;
  HttpStream requests_, answers_;
  std::string path_;
};

}  // namespace adit::simulation
