// The head of a request.
#include "intake/head_checker.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

using intake::HeadChecker;
using Verdict = HeadChecker::Verdict;

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
}

}  // namespace

void try_heads(Input head) {
  const std::size_t piece = take_piece(head);
  HeadChecker at_once, cut;
  const Verdict verdict = at_once.look(head);
  Verdict so_far = Verdict::More;
  for (std::size_t here = piece; so_far == Verdict::More; here += piece) {
    so_far = cut.look(std::string(head.substr(0, here)));  // which lies elsewhere each time
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
