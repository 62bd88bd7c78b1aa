#include <algorithm>

#include "api/self_test.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

/// Much longer than all steps together.
constexpr PollPolicy kTesting{
    .within = std::chrono::minutes(2),
    .every = std::chrono::milliseconds(250),
    .late = "the test has not ended after 2 minutes: see the log on the System page"};

bool has_ended(const api::TestStep& step) {
  return step.state == "good" || step.state == "bad" || step.state == "skipped";
}

std::string line_of(const api::TestStep& step, bool colour) {
  const Tone tone = step.state == "good" ? Tone::Good : step.state == "bad" ? Tone::Bad : Tone::Faint;
  const std::string word = step.state == "bad" ? "BAD" : step.state;
  std::string line =
      "  " + host::escape(step.name) + std::string(9 - std::min<std::size_t>(step.name.size(), 8), ' ') +
      paint(host::escape(word), tone, colour) + std::string(9 - std::min<std::size_t>(word.size(), 8), ' ') +
      host::escape(step.said) + '\n';
  if (!step.advice.empty()) line += std::string(11, ' ') + host::escape(step.advice) + '\n';
  return line;
}

/// Prints newly finished steps, in order.
class Progress {
 public:
  Progress(bool colour, const std::function<void(const std::string&)>& print)
      : colour_(colour), print_(print) {}

  void show(const api::TestView& view) {
    std::size_t number = 0;
    for (const api::TestedEndpoint& endpoint : view.endpoints) {
      for (const api::TestStep& step : endpoint.steps) {
        if (number++ < printed_) continue;
        if (!has_ended(step)) return;
        if (&step == &endpoint.steps.front())
          print_(host::escape(endpoint.name + " " + endpoint.address) + '\n');
        print_(line_of(step, colour_));
        ++printed_;
      }
    }
  }

 private:
  bool colour_;
  const std::function<void(const std::string&)>& print_;
  std::size_t printed_ = 0;
};

bool is_bad(const api::TestView& view) {
  return std::ranges::any_of(view.endpoints, [](const api::TestedEndpoint& endpoint) {
    return std::ranges::any_of(endpoint.steps, [](const api::TestStep& step) { return step.state == "bad"; });
  });
}

/// False also for an aditd that restarted during the test, because it has no steps.
bool is_whole(const api::TestView& view) {
  return !view.endpoints.empty() && std::ranges::all_of(view.endpoints, [](const auto& endpoint) {
    return std::ranges::all_of(endpoint.steps, has_ended);
  });
}

using codec::Value;

/// An endpoint for POST /adit/test; null if none is named.
Result<Value> endpoint_to_try(const std::optional<settings::Address>& at, const std::string& token_file) {
  Value::Object endpoint;
  if (at) endpoint = {{"address", {at->address}}, {"port", {std::int64_t{at->port}}}};
  if (!token_file.empty()) {
    const auto token = token_in_file(token_file);
    if (!token) return to_failure(token.error());
    endpoint.emplace_back("token", Value{token->token.reveal()});
  }
  return endpoint.empty() ? Value{} : Value{std::move(endpoint)};
}

/// The body of POST /adit/test; "": test the settings in use.
Result<std::string> body_for(const Trial& trial) {
  if (trial.is_for_current_settings()) return "";
  const auto scoring = ADIT_TRY(endpoint_to_try(trial.scoring, trial.scoring_token));
  const auto mapping = ADIT_TRY(endpoint_to_try(trial.mapping, trial.mapping_token));
  Value::Object body = {{"scoring", scoring}, {"mapping", mapping}};
  if (!trial.course.empty()) body.emplace_back("course", Value{trial.course});
  return codec::write_json({std::move(body)});
}

}  // namespace

Result<Outcome> test(const Call& call) {
  const auto& [adit, options, console] = call;
  const bool is_of_use = options.trial.is_for_current_settings();
  auto body = ADIT_TRY(body_for(options.trial));
  const auto begun = post(adit, {.target = "/adit/test", .check = "adit test", .body = std::move(body)});
  const bool is_joined = !begun && begun.error().status == 409 && is_of_use;
  if (!begun && !is_joined) return std::unexpected(begun.error());
  Progress progress(console.colour, console.print);
  const auto is_other = [&](const api::TestView& view) { return view.applied != is_of_use || view.outdated; };
  const auto told =
      ADIT_TRY(fetch_until<api::TestView>(adit, "/adit/test", kTesting, [&](const api::TestView& view) {
        if (!is_other(view) && !options.json) progress.show(view);
        return is_other(view) || !view.running;
      }));
  const api::TestView& view = told.row;
  if (view.applied != is_of_use)
    return to_failure("a test of other values is running: try again when it has ended");
  if (view.outdated) return to_failure("the settings changed during the test: start it again");
  if (options.json) console.print(told.json + '\n');
  if (!is_whole(view))
    return to_failure("the test was interrupted, perhaps by a restart of Adit: start it again");
  return Outcome{is_bad(view) ? Exit::Attention : Exit::Fine, "", ""};
}

}  // namespace adit::cli
