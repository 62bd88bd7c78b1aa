#include "api/network_routes.hpp"

#include "api/after.hpp"
#include "api/answers.hpp"
#include "api/settings_rows.hpp"
#include "codec/json.hpp"
#include "codec/row.hpp"

namespace adit::api {
namespace {

/// The numbers, or all errors of the body.
std::expected<network::Numbers, std::vector<settings::Error>> numbers_in(const std::string& body) {
  const auto value = codec::parse_json(body);
  if (value) return network::read_numbers(*value);
  return std::unexpected(std::vector<settings::Error>{{"", "expected JSON: " + value.error()}});
}

intake::Answer unfit(const std::vector<settings::Error>& errors) {
  std::string sentences;
  for (const settings::Error& error : errors) sentences += (sentences.empty() ? "" : "; ") + error.sentence();
  return refusal(icd::Status::UnprocessableEntity, sentences);
}

}  // namespace

namespace network_routes {

intake::Answer check(Network& network, const Call& call) {
  const auto wanted = numbers_in(call.body);
  const auto findings =
      wanted ? network.check(*wanted, call.head.peer()) : network::Findings{wanted.error(), {}, {}};
  CheckView checked{.errors = findings.errors, .changes = {.changes = {}, .warnings = findings.warnings}};
  for (const network::Difference& each : findings.changes)
    checked.changes.changes.push_back({each.path, {each.from}, {each.to}});
  return fresh(checked);
}

intake::Answer change(Network& network, const Call& call) {
  const auto wanted = numbers_in(call.body);
  if (!wanted) return unfit(wanted.error());
  const auto findings = network.check(*wanted, call.head.peer());
  if (!findings.errors.empty()) return unfit(findings.errors);
  return after(network, network.change(*wanted));
}

intake::Answer confirm(Network& network, const Call& call) {
  return after(network, network.confirm(call.head.local()));
}

}  // namespace network_routes
}  // namespace adit::api
