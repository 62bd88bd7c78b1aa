// What single fields of a request say: its target, who asks from where, with which token and cookie, and how
// its body is coded; and the line before a connection by TLS.
#include <algorithm>
#include <string>

#include "access/admission.hpp"
#include "codec/body_decoder.hpp"
#include "icd/bearer_token.hpp"
#include "intake/head.hpp"
#include "intake/proxy_listener.hpp"
#include "target.hpp"
#include "uplink/exchange.hpp"

namespace adit::fuzz {
namespace {

bool lies_in(std::string_view part, Input whole) {
  return part.empty() || whole.contains(part);
}

/// A whole header ends at the first CRLF. The bytes after it have no effect, and no part of it is refused.
void try_proxy_header(Input text) {
  using intake::ProxyHeader;
  const auto header = ProxyHeader::parse(text);
  const Input line = text.substr(0, std::min(text.find("\r\n"), text.size()));
  if (!header) {
    const bool ends = header.error() == ProxyHeader::Missing::Refused;
    require(ends || (text.size() < ProxyHeader::kMostBytes && line.size() == text.size()));
    const auto longer = ProxyHeader::parse(std::string(text) + "x");
    require(!ends || longer == std::unexpected(ProxyHeader::Missing::Refused));
    return;
  }
  require(header->size == line.size() + 2 && header->size <= ProxyHeader::kMostBytes);
  for (std::size_t size = 0; size < header->size; ++size)
    require(ProxyHeader::parse(text.substr(0, size)) == std::unexpected(ProxyHeader::Missing::More));
  for (const std::string& address : {header->peer, header->local})
    require(address.find_first_not_of("0123456789abcdef:.") == std::string::npos && address.size() >= 2);
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
  if (access::is_same_origin(first, second, false)) require(first.size() > second.size());
  if (access::names_this_box(first)) {
    require(std::ranges::all_of(first, [](char c) { return c > ' ' && c <= '~'; }));
  }

  try_proxy_header(text);
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
