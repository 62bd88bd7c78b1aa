#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/try.hpp"

namespace adit::cli {

std::string tokens_text(const std::vector<api::TokenRow>& tokens, bool colour) {
  Table table({{}, {}, {}});
  for (const auto& [name, set, warning] : tokens)
    table.add({{name, Tone::Strong},
               {set ? "set" : "not set", set ? Tone::Good : Tone::Warning},
               {warning, Tone::Warning}});
  return table.to_text(colour);
}

namespace {

using codec::Value;

constexpr const char* kOperator = "operator";

Result<Outcome> change_token(const Call& call, const Value& token, const std::string& done) {
  return act(
      call,
      {.target = "/adit/tokens",
       .check = "adit tokens",
       .body = codec::write_json({Value::Object{{"name", {call.options.argument()}}, {"token", token}}})},
      done);
}

/// `what`: "the operator's present password".
Result<std::string> read_password(const Console& console, const std::string& what) {
  const auto text = console.read_secret(what + ": ");
  if (!text)
    return to_failure(what + " is missing: type it at a terminal, or pipe a line for each into adit");
  return *text;
}

/// Twice at a terminal, where it is not shown.
Result<std::string> read_new_password(const Call& call, const std::string& role) {
  auto password = ADIT_TRY(read_password(call.console, "new password of the " + role));
  const auto again = ADIT_TRY(read_password(call.console, "the new password again"));
  if (again != password) return to_failure("the two new passwords differ; the password was not changed");
  return password;
}

/// Whether no password is set yet.
Result<bool> is_first_start(const Adit& adit) {
  const auto json = ADIT_TRY(get(adit, "/adit/session"));
  const auto session = ADIT_TRY(json_in(adit, json));
  codec::Reading reading;
  const codec::Field root(session, reading);
  const bool first_start = root.member("first_start").truth();
  const auto outcome = reading.outcome(first_start);
  if (!outcome) return to_failure(outcome.error().sentence);
  return *outcome;
}

Result<Outcome> change_password(const Call& call, const std::string& role, bool removes) {
  const bool first_start = ADIT_TRY(is_first_start(call.adit));
  const char* const known = first_start ? "the box's code" : "the operator's present password";
  Value::Object body{{"role", {role}}};
  body.emplace_back(first_start ? "code" : "current", Value{ADIT_TRY(read_password(call.console, known))});
  body.emplace_back("password", removes ? Value{} : Value{ADIT_TRY(read_new_password(call, role))});
  return act(
      call, {.target = "/adit/password", .check = "the page", .body = codec::write_json({std::move(body)})},
      "the password of the " + role + (removes ? " is removed\n" : " is set; its sessions have ended\n"));
}

}  // namespace

Result<Outcome> show_tokens(const Call& call) {
  const auto setup = ADIT_TRY(fetch<api::SetupView>(call.adit, "/adit/settings"));
  Value::Array tokens;
  for (const auto& [name, set, warning] : setup.row.tokens)
    tokens.push_back({Value::Object{{"name", {name}}, {"set", {set}}, {"warning", {warning}}}});
  return print_result(call, codec::write_json({tokens}), tokens_text(setup.row.tokens, call.console.colour));
}

Result<Outcome> set_token(const Call& call) {
  const std::string name = call.options.argument(0), file = call.options.argument(1);
  std::optional<icd::BearerToken> token;
  if (file.empty() || file == "-") {
    token = ADIT_TRY(read_token(call.console, "token " + name + ": "));
  } else {
    auto read = token_in_file(file);
    if (!read) return to_failure(read.error());
    token = std::move(read->token);
  }
  return change_token(call, {token->reveal()}, "token " + name + " is set\n");
}

Result<Outcome> remove_token(const Call& call) {
  return change_token(call, {}, "token " + call.options.argument() + " is removed\n");
}

Result<Outcome> set_password(const Call& call) {
  const std::string role = call.options.argument().empty() ? kOperator : call.options.argument();
  return change_password(call, role, false);
}

Result<Outcome> remove_password(const Call& call) {
  return change_password(call, "viewer", true);
}

Result<Outcome> reset_box(const Call& call) {
  ADIT_TRY(confirm(call.options, call.console,
                   "Settings, tokens, passwords and sessions will be deleted for good; the reports are kept. "
                   "The box returns to the addresses that it had when it was new.",
                   "Reset the box?", "the box was not reset"));
  const auto password = ADIT_TRY(read_password(call.console, "the operator's present password"));
  return act(call,
             {.target = "/adit/reset",
              .check = "adit settings",
              .body = codec::write_json({Value::Object{{"password", {password}}}})},
             "the box is reset\n");
}

}  // namespace adit::cli
