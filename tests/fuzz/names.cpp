// What single fields of a request say: its target, who asks from where, with which token and cookie, and how
// its body is coded.
#include <algorithm>

#include "access/admission.hpp"
#include "codec/body_decoder.hpp"
#include "icd/bearer_token.hpp"
#include "intake/head.hpp"
#include "target.hpp"
#include "uplink/exchange.hpp"

namespace adit::fuzz {
namespace {

bool lies_in(std::string_view part, Input whole) {
  return part.empty() || whole.contains(part);
}

}  // namespace

void try_names(Input text) {
  if (const auto target = intake::parse_target(text)) {
    require(target->path == "*" || target->path.starts_with('/'));
    require(!target->path.contains('\0') && target->query.size() <= text.size());
  }

  const auto middle = text.find('\n');
  const Input first = text.substr(0, middle);
  const Input second = middle == Input::npos ? Input() : text.substr(middle + 1);
  require(lies_in(access::cookie_in(first, "adit"), first));
  require(lies_in(icd::token_in(first), first));
  if (access::is_same_origin(first, second)) require(first.size() > second.size());
  if (access::names_this_box(first)) {
    require(std::ranges::all_of(first, [](char c) { return c > ' ' && c <= '~'; }));
  }

  (void)codec::format_of(text);
  (void)codec::coding_of(text);
  (void)uplink::http_date(std::string(text));
  if (const auto token = icd::BearerToken::parse(text)) {
    require(token->matches(text));
    std::string said = "it said " + std::string(text);
    token->strike_from(said);
    require(text.size() < 4 || !said.ends_with(text) || text.ends_with(']'));
  }
}

}  // namespace adit::fuzz
