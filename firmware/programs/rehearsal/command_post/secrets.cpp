#include "rehearsal/command_post/secrets.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>

#include "rehearsal/command_post/fields.hpp"

namespace adit::rehearsal {
namespace {

std::expected<std::string, std::string> read_token(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::unexpected(path + ": cannot be read");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::string token(trimmed(text));
  const bool visible = std::ranges::all_of(token, [](char c) { return c > 0x20 && c < 0x7f; });
  if (token.empty() || !visible)
    return std::unexpected(path + ": expected one token of visible ASCII characters");
  return token;
}

}  // namespace

std::expected<Secrets, std::string> read_secrets(const std::string& folder) {
  auto scoring = read_token(folder + "/scoring.token");
  if (!scoring) return std::unexpected(scoring.error());
  auto mapping = read_token(folder + "/mapping.token");
  if (!mapping) return std::unexpected(mapping.error());
  return Secrets{std::move(*scoring), std::move(*mapping)};
}

}  // namespace adit::rehearsal
