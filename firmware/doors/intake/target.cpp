#include "intake/target.hpp"

#include "codec/utf8.hpp"

namespace adit::intake {
namespace {

int hex_digit(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  const char small = static_cast<char>(letter | 0x20);
  return small >= 'a' && small <= 'f' ? small - 'a' + 10 : -1;
}

bool is_text(std::string_view bytes) {
  codec::Utf8Checker checker;
  return bytes.find('\0') == std::string_view::npos && !checker.feed(bytes) && checker.complete();
}

enum class Plus { Stays, IsSpace };

std::optional<std::string> decode(std::string_view raw, Plus plus) {
  std::string text;
  text.reserve(raw.size());
  for (std::size_t i = 0; i < raw.size(); ++i) {
    if (raw[i] == '%') {
      if (raw.size() - i < 3) return std::nullopt;
      const int high = hex_digit(raw[i + 1]);
      const int low = hex_digit(raw[i + 2]);
      if (high < 0 || low < 0) return std::nullopt;
      text.push_back(static_cast<char>(high * 16 + low));
      i += 2;
    } else {
      text.push_back(raw[i] == '+' && plus == Plus::IsSpace ? ' ' : raw[i]);
    }
  }
  if (!is_text(text)) return std::nullopt;
  return text;
}

/// The absolute form (RFC 9112 3.2.2) without its scheme and authority.
std::string_view origin_form(std::string_view raw) {
  const auto scheme_end = raw.find("://");
  if (raw.starts_with('/') || scheme_end == std::string_view::npos) return raw;
  const auto path = raw.find('/', scheme_end + 3);
  return path == std::string_view::npos ? "/" : raw.substr(path);
}

}  // namespace

std::optional<Target> parse_target(std::string_view raw) {
  raw = origin_form(raw);
  raw = raw.substr(0, raw.find('#'));
  const auto mark = raw.find('?');
  auto path = decode(raw.substr(0, mark), Plus::Stays);
  if (!path || (!path->starts_with('/') && *path != "*")) return std::nullopt;

  Target target{.path = std::move(*path), .query = {}};
  std::string_view rest = mark == std::string_view::npos ? std::string_view{} : raw.substr(mark + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(pair.size() + 1, rest.size()));
    const auto equals = pair.find('=');
    auto name = decode(pair.substr(0, equals), Plus::IsSpace);
    auto value = decode(equals == std::string_view::npos ? std::string_view{} : pair.substr(equals + 1),
                        Plus::IsSpace);
    if (!name || !value) return std::nullopt;
    target.query.emplace_back(std::move(*name), std::move(*value));
  }
  return target;
}

}  // namespace adit::intake
