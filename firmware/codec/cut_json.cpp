#include "codec/cut_lists.hpp"

namespace adit::codec {
namespace {

/// `at`: of a string's first quote; gives that of its last.
std::size_t end_of_string(std::string_view text, std::size_t at) {
  while (text[++at] != '"') {
    if (text[at] == '\\') ++at;
  }
  return at;
}

std::uint32_t offset(std::size_t at) {
  return static_cast<std::uint32_t>(at);  // a text that is cut has a few MB
}

/// `at`: of an array's first bracket, and then of its last.
Starts starts_in(std::string_view text, std::size_t& at) {
  Starts starts;
  if (text[++at] == ']') return starts;
  starts.push_back(offset(at));
  for (std::size_t depth = 0;; ++at) {
    switch (text[at]) {
      case '"':
        at = end_of_string(text, at);
        break;
      case '[':
      case '{':
        ++depth;
        break;
      case ',':
        if (depth == 0) starts.push_back(offset(at + 1));
        break;
      case ']':
      case '}':
        if (depth-- > 0) break;
        starts.push_back(offset(at + 1));
        return starts;
      default:
        break;
    }
  }
}

}  // namespace

Cut cut_json(std::string_view text, std::size_t begin, std::size_t end) {
  Cut cut{.rest = {}, .arrays = {}, .values = 1};
  std::size_t kept = begin;
  for (std::size_t at = begin; at < end; ++at) {
    switch (text[at]) {
      case '"':
        at = end_of_string(text, at);
        break;
      case '{':
      case ',':
        ++cut.values;
        break;
      case '[':
        cut.rest += text.substr(kept, at + 1 - kept);
        cut.arrays.push_back(starts_in(text, at));
        kept = at;
        break;
      default:
        break;
    }
  }
  cut.rest += text.substr(kept, end - kept);
  return cut;
}

}  // namespace adit::codec
