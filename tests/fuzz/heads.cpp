// The head of a request, in pieces: the input's last byte says how large they are.
#include <cstdlib>
#include <string>

#include "intake/head_checker.hpp"

namespace {

using adit::intake::HeadChecker;
using Verdict = HeadChecker::Verdict;

void require(bool law) {
  if (!law) std::abort();
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
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0) return 0;
  const std::string head(reinterpret_cast<const char*>(bytes), size - 1);
  const std::size_t piece = 1U + bytes[size - 1] % 64U;
  HeadChecker at_once, in_pieces;
  const Verdict verdict = at_once.look(head);
  Verdict so_far = Verdict::More;
  for (std::size_t here = piece; so_far == Verdict::More; here += piece) {
    so_far = in_pieces.look(std::string(head.substr(0, here)));
    if (here >= head.size()) break;
  }
  require(so_far == verdict);
  if (verdict == Verdict::Refused) {
    require(at_once.refusal() == in_pieces.refusal() && !at_once.refusal().sentence.empty());
  } else if (verdict == Verdict::Whole) {
    require(at_once.size() == in_pieces.size());
    require(at_once.framing().length == in_pieces.framing().length);
    require(at_once.framing().has_body == (at_once.framing().length != 0));
    require_plain(std::string_view(head).substr(0, at_once.size()));
  }
  return 0;
}
