#include "options.hpp"

#include <charconv>
#include <optional>
#include <string_view>

#include "icd/sentence.hpp"

namespace adit::bench {
namespace {

template <class Number>
std::optional<Number> whole(std::string_view text) {
  Number number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || number == 0) return std::nullopt;
  return number;
}

std::optional<Way> way(std::string_view word) {
  const std::size_t equals = word.find('=');
  if (equals == std::string_view::npos || equals == 0) return std::nullopt;
  const std::string_view where = word.substr(equals + 1);
  const std::size_t colon = std::min(where.find(':'), where.size());
  const auto port = whole<std::uint16_t>(where.substr(0, colon));
  if (!port) return std::nullopt;
  const auto process = whole<pid_t>(where.substr(std::min(colon + 1, where.size())));
  return Way{.name = std::string(word.substr(0, equals)), .port = *port, .process = process.value_or(0)};
}

/// False where the option is unknown or its value is none.
bool set(Options& options, std::string_view name, std::string_view value) {
  if (name == "--flush") options.flush = value;
  if (name == "--token") options.token = value;
  if (name == "--flush" || name == "--token") return !value.empty();
  const auto number = whole<std::uint32_t>(value);
  if (!number) return false;
  if (name == "--reports") return options.reports = *number, true;
  if (name == "--seconds") return options.most = std::chrono::seconds(*number), true;
  if (name == "--pace") return options.pace = std::chrono::milliseconds(*number), true;
  if (name == "--block") return options.block = *number, true;
  return false;
}

}  // namespace

std::expected<Options, std::string> parse_options(std::span<char* const> arguments) {
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view word = arguments[i];
    if (auto made = way(word); made) {
      options.ways.push_back(*std::move(made));
    } else if (i + 1 == arguments.size() || !set(options, word, arguments[i + 1])) {
      return std::unexpected(icd::sentence("'", word, "' is unknown, or its value is wrong or missing"));
    } else {
      ++i;
    }
  }
  if (options.ways.size() < 2 || options.flush.empty() || options.token.empty())
    return std::unexpected("--flush, --token and two ways are needed");
  return options;
}

}  // namespace adit::bench
