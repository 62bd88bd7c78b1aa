// The head of a request.
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "intake/head_checker.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

using intake::HeadChecker;
using Verdict = HeadChecker::Verdict;

/// Of the fields of that name.
std::vector<std::string> values_of(std::string_view head, std::string_view name) {
  std::vector<std::string> values;
  while (!head.empty()) {
    const std::string_view line = head.substr(0, head.find("\r\n"));
    head.remove_prefix(std::min(line.size() + 2, head.size()));
    const auto same = [](char one, char other) {
      return one == std::tolower(static_cast<unsigned char>(other));
    };
    if (!std::ranges::equal(name, line.substr(0, line.find(':')), same)) continue;
    const std::string value(line.substr(std::min(name.size() + 1, line.size())));
    const auto first = value.find_first_not_of(" \t"), last = value.find_last_not_of(" \t");
    values.push_back(first == value.npos ? "" : value.substr(first, last - first + 1));
  }
  return values;
}

/// What libmicrohttpd, or a proxy, could read in another way.
void require_plain(std::string_view head) {
  require(head.size() <= HeadChecker::kMostBytes && head.ends_with("\r\n\r\n"));
  for (std::size_t i = 0; i < head.size(); ++i) {
    const char byte = head[i];
    if (byte == '\r') require(i + 1 < head.size() && head[i + 1] == '\n');
    if (byte == '\n') require(i > 0 && head[i - 1] == '\r');
    require(byte != '\0' && byte != '\x7f');
  }
  require(!head.contains("\r\n ") && !head.contains("\r\n\t") && !head.contains("\r\n:"));
  for (const std::string_view name : {"host", "content-encoding"}) require(values_of(head, name).size() <= 1);
  for (const std::string_view name : {"content-type", "authorization", "origin"}) {
    const auto values = values_of(head, name);
    require(std::ranges::count(values, values.empty() ? "" : values[0]) == std::ssize(values));
  }
}

}  // namespace

void try_heads(Input head) {
  const std::size_t piece = take_piece(head);
  HeadChecker at_once, cut;
  const Verdict verdict = at_once.check(head);
  Verdict so_far = Verdict::More;
  for (std::size_t here = piece; so_far == Verdict::More; here += piece) {
    so_far = cut.check(std::string(head.substr(0, here)));  // which lies elsewhere each time
    if (here >= head.size()) break;
  }
  require(so_far == verdict);
  if (verdict == Verdict::Refused) {
    require(at_once.refusal() == cut.refusal() && !at_once.refusal().sentence.empty());
  } else if (verdict == Verdict::Whole) {
    require(at_once.size() == cut.size());
    require(at_once.framing().length == cut.framing().length);
    require(at_once.framing().has_body == (at_once.framing().length != 0));
    require_plain(head.substr(0, at_once.size()));
  }
}

}  // namespace adit::fuzz
