#include "icd/in_html.hpp"

namespace adit::icd {

std::string in_html(std::string_view text) {
  std::string all;
  all.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        all += "&amp;";
        break;
      case '<':
        all += "&lt;";
        break;
      case '>':
        all += "&gt;";
        break;
      case '"':
        all += "&quot;";
        break;
      case '\'':
        all += "&#39;";
        break;
      case '\n':
      case '\t':
        all += ' ';
        break;
      default:
        all += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? "\uFFFD" : std::string(1, c);
    }
  }
  return all;
}

}  // namespace adit::icd
