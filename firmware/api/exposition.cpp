#include "api/exposition.hpp"

#include <charconv>
#include <cmath>

namespace adit::api {
namespace {

/// Escapes backslashes and newlines, and in a label's value quotation marks.
std::string escaped(std::string_view text, bool quoted) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    if (c == '\\' || (quoted && c == '"')) safe += '\\';
    if (c == '\n') {
      safe += "\\n";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string sample_text(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "+Inf" : "-Inf";
  char text[32];
  const auto [end, error] = std::to_chars(text, text + sizeof text, value);
  return {text, end};
}

}  // namespace

void Exposition::begin(std::string_view name, std::string_view type, std::string_view help) {
  name_ = name;
  text_.append("# HELP ").append(name).append(" ").append(escaped(help, false)).append("\n");
  text_.append("# TYPE ").append(name).append(" ").append(type).append("\n");
}

void Exposition::sample(std::initializer_list<Label> labels, double value) {
  text_ += name_;
  char before = '{';
  for (const auto& [name, text] : labels) {
    text_.append(1, before).append(name).append("=\"").append(escaped(text, true)).append("\"");
    before = ',';
  }
  if (labels.size() > 0) text_ += '}';
  text_.append(" ").append(sample_text(value)).append("\n");
}

}  // namespace adit::api
