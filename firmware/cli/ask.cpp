#include "cli/ask.hpp"

#include <algorithm>
#include <cstdlib>
#include <thread>

#include "alarms/board.hpp"
#include "api/run_view.hpp"
#include "cli/http_client.hpp"
#include "cli/reading.hpp"
#include "cli/status_text.hpp"
#include "cli/where.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "host/service.hpp"

namespace adit::cli {
namespace {

constexpr std::chrono::seconds kActionPatience{10};  // an action is on the disk before it is answered

bool all_is_well(const api::RunView& view) {
  return std::ranges::none_of(view.alarms, alarms::calls);
}

/// The option's value, or else the variable's; "" if neither is set.
std::string given(const std::string& option, const char* variable) {
  const char* const value = std::getenv(variable);
  return option.empty() && value != nullptr ? value : option;
}

std::expected<settings::Address, std::string> address_in(const std::string& file) {
  const auto text = host::read_file(file);
  if (!text) return std::unexpected(text.error() + "; give Adit's address by --at ADDR[:PORT]");
  const auto settings = settings::parse(*text);
  if (!settings) {
    return std::unexpected(file + ": " + settings.error().front().sentence() + " (see adit check)");
  }
  return reach(settings->team);
}

std::expected<settings::Address, std::string> address_of(const Options& options) {
  const bool file_named = options.settings != kGivenSettings;
  const std::string at = file_named ? options.at : given(options.at, "ADIT_AT");
  if (!at.empty()) {
    auto address = parse_address(at);
    if (!address) return std::unexpected((options.at.empty() ? "ADIT_AT: " : "--at: ") + address.error());
    return address;
  }
  const bool saved = !file_named && host::read_file(options.saved_settings);
  return address_in(saved ? options.saved_settings : options.settings);
}

}  // namespace

std::expected<Adit, std::string> adit_of(const Options& options) {
  const auto address = address_of(options);
  if (!address) return std::unexpected(address.error());
  const std::vector<std::string> folders = {options.saved_secrets, options.secrets};
  auto token = find_token(given(options.token_file, "ADIT_TOKEN_FILE"), folders);
  if (!token) return std::unexpected(token.error());
  if (*token) return Adit{*address, std::move(**token)};
  return std::unexpected("cannot read a token in " + options.saved_secrets + " or " + options.secrets +
                         ": set the team's token on the page, run adit as root, or name a token file by "
                         "--token-file FILE");
}

std::expected<std::string, std::string> get(const Adit& adit, const std::string& target) {
  auto reply = http_ask(adit.address, {.target = target, .token = adit.token.token}, kReadPatience);
  if (!reply) return std::unexpected(reply.error().sentence);
  if (reply->status == 200) return std::move(reply->body);
  return std::unexpected(failure(adit, *reply).sentence);
}

Failure failure(const Adit& adit, const HttpReply& reply) {
  if (reply.status == 401) return {Exit::Unable, "Adit rejects the token in " + adit.token.file};
  const std::string sentence = sentence_in(reply.body);
  if (sentence.empty())
    return {Exit::Unable, "the server at " + written(adit.address) +
                              " is not Adit, or is another version (HTTP status " +
                              std::to_string(reply.status) + ")"};
  const bool decided =
      reply.status == 404 || reply.status == 409 || reply.status == 413 || reply.status == 422;
  return {decided ? Exit::Attention : Exit::Unable, sentence};
}

std::expected<std::string, Failure> find(const Adit& adit, const std::string& target,
                                         std::chrono::milliseconds within) {
  auto reply = http_ask(adit.address, {.target = target, .token = adit.token.token}, within);
  if (!reply) return std::unexpected(Failure{Exit::Unable, reply.error().sentence});
  if (reply->status != 200) return std::unexpected(failure(adit, *reply));
  return std::move(reply->body);
}

std::expected<std::string, Failure> post(const Adit& adit, const std::string& target, const std::string& body,
                                         const std::string& check) {
  auto reply = http_ask(
      adit.address,
      {.method = HttpRequest::Method::Post, .target = target, .token = adit.token.token, .body = body},
      kActionPatience);
  if (!reply) {
    const std::string unsure = reply.error().sent ? "; the action may have been done: see " + check : "";
    return std::unexpected(Failure{Exit::Unable, reply.error().sentence + unsure});
  }
  if (reply->status != 200) return std::unexpected(failure(adit, *reply));
  return std::move(reply->body);
}

std::string sentence_in(const std::string& body) {
  const auto value = codec::parse_json(body);
  const auto* sentence = value ? std::get_if<std::string>(&value->is) : nullptr;
  return sentence == nullptr ? "" : *sentence;
}

bool wait_for(std::chrono::milliseconds within, std::chrono::milliseconds every,
              const std::function<bool()>& is_over) {
  for (const auto end = std::chrono::steady_clock::now() + within; !is_over();) {
    if (std::chrono::steady_clock::now() >= end) return false;
    std::this_thread::sleep_for(every);
  }
  return true;
}

std::expected<api::RunView, std::string> run_view(const Adit& adit) {
  const auto json = get(adit, "/adit/run");
  if (!json) return std::unexpected(json.error());
  return read<api::RunView>(adit, *json);
}

Outcome unable(const std::string& why) {
  return {Exit::Unable, "", "adit: " + host::escaped(why) + '\n'};
}

Outcome unable(const Failure& failure) {
  return {failure.exit, "", unable(failure.sentence).err};
}

Outcome status(const Options& options, bool colour) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  const auto json = get(*adit, "/adit/run");
  if (!json) return unable(json.error());
  const auto view = read<api::RunView>(*adit, *json);
  if (!view) return unable(view.error());
  const Exit exit = all_is_well(*view) ? Exit::Fine : Exit::Attention;
  return {exit, options.json ? *json + '\n' : status_text(*view, colour), ""};
}

}  // namespace adit::cli
