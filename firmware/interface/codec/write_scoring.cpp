// The scoring endpoint's messages (ICD 5), and JSON strings for error replies (ICD 4).
#include <algorithm>
#include <cmath>

#include "codec/utf8.hpp"
#include "codec/write.hpp"
#include "icd/hex.hpp"
#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

/// The fewest digits that preserve the double, in the ICD's form of <float>: 11.0, not 11. Messages never
/// hold NaN or infinity; if one did, it would become null, and the server would reject a needed field.
std::string json_number(double number) {
  return std::isfinite(number) ? icd::real_text(number) : "null";
}

/// Bytes of the first UTF-8 character of `text`, or 0.
std::size_t character_size(std::string_view text) {
  Utf8Checker checker;
  for (std::size_t i = 0; i < text.size() && checker.next(static_cast<std::uint8_t>(text[i])); ++i) {
    if (checker.complete()) return i + 1;
  }
  return 0;
}

void append_escaped(std::string& out, char control) {
  switch (control) {
    case '\n':
      out += "\\n";
      return;
    case '\r':
      out += "\\r";
      return;
    case '\t':
      out += "\\t";
      return;
    default:
      out += "\\u00" + icd::hex(static_cast<std::uint8_t>(control));
  }
}

bool stands_for_itself(char letter) {
  return letter >= ' ' && letter <= '~' && letter != '"' && letter != '\\';
}

}  // namespace

std::string write_artifact_report(const icd::ArtifactReport& report) {
  return icd::sentence(
      "{\"x\": ", json_number(report.position.x), ", \"y\": ", json_number(report.position.y),
      ", \"z\": ", json_number(report.position.z), ", \"type\": ", json_string(report.type),
      report.robot ? icd::sentence(", \"name\": ", json_string(report.robot->text())) : "", "}");
}

std::string json_string(std::string_view text) {
  std::string out = "\"";
  while (!text.empty()) {
    const auto plain =
        static_cast<std::size_t>(std::ranges::find_if_not(text, stands_for_itself) - text.begin());
    out += text.substr(0, plain);
    text.remove_prefix(plain);
    if (text.empty()) break;
    const std::size_t size = character_size(text);
    if (size == 0) {
      out += "\xef\xbf\xbd";  // U+FFFD
    } else if (static_cast<std::uint8_t>(text[0]) < 0x20 || text[0] == 0x7f) {
      append_escaped(out, text[0]);
    } else {
      if (text[0] == '"' || text[0] == '\\') out += '\\';
      out += text.substr(0, size);
    }
    text.remove_prefix(std::max<std::size_t>(size, 1));
  }
  out += '"';
  return out;
}

}  // namespace adit::codec
