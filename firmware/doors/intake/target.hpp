#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace adit::intake {

/// A request's target (RFC 9112 3.2), percent-decoded once.
struct Target {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;  // in the order given
};

/// Parses the origin form, the absolute form and `*`. nullopt for another form, a NUL or invalid UTF-8.
std::optional<Target> parse_target(std::string_view raw);

}  // namespace adit::intake
