#include "cli/ask.hpp"

#include <algorithm>

#include "cli/http_get.hpp"
#include "cli/reports_text.hpp"
#include "cli/run_view.hpp"
#include "cli/status_text.hpp"
#include "cli/where.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::cli {
namespace {

constexpr std::chrono::seconds kPatience{3};

std::expected<settings::Address, std::string> address_of(const Options& options) {
  if (!options.at.empty()) return parse_address(options.at);
  const auto text = host::read_file(options.settings);
  if (!text) return std::unexpected(text.error() + " (say where Adit listens by --at ADDR:PORT)");
  const auto settings = settings::parse(*text);
  if (!settings) {
    return std::unexpected(options.settings + ": " + settings.error().front().sentence() +
                           " (see: adit check)");
  }
  return reach(settings->team);
}

/// What Adit said, as it said it and as it is meant.
struct Answer {
  std::string json;
  page::RunView view;
};

std::expected<Answer, std::string> ask(const Options& options) {
  const auto address = address_of(options);
  if (!address) return std::unexpected(address.error());
  auto json = http_get(*address, "/adit/run", kPatience);
  if (!json) return std::unexpected(json.error());
  auto view = read_run_view(*json);
  if (!view)
    return std::unexpected("Adit at " + written(*address) + " cannot be understood: " + view.error());
  return Answer{std::move(*json), std::move(*view)};
}

Outcome unable(const std::string& why) {
  return {Exit::Unable, "", "adit: " + host::escaped(why) + '\n'};
}

bool all_is_well(const page::RunView& view) {
  return view.attention.empty() &&
         std::ranges::all_of(view.endpoints, &std::string::empty, &page::EndpointRow::trouble);
}

/// Only the reports, as Adit wrote them. The document has been read before, so that it has them.
std::string reports_alone(const std::string& json) {
  const auto root = codec::parse_json(json);
  const auto& members = std::get<codec::Value::Object>(root->is);
  return codec::write_json(std::ranges::find(members, "reports", &codec::Value::Member::first)->second) +
         '\n';
}

}  // namespace

Outcome status(const Options& options, bool colour) {
  const auto answer = ask(options);
  if (!answer) return unable(answer.error());
  const Exit exit = all_is_well(answer->view) ? Exit::Fine : Exit::Attention;
  return {exit, options.json ? answer->json + '\n' : status_text(answer->view, colour), ""};
}

Outcome reports(const Options& options, bool colour) {
  const auto answer = ask(options);
  if (!answer) return unable(answer.error());
  const Exit exit = any_in_doubt(answer->view) ? Exit::Attention : Exit::Fine;
  return {exit, options.json ? reports_alone(answer->json) : reports_text(answer->view, colour), ""};
}

}  // namespace adit::cli
