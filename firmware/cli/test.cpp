#include "cli/test.hpp"

#include <algorithm>
#include <thread>
#include <vector>

#include "api/self_test.hpp"
#include "cli/ask.hpp"
#include "cli/http_client.hpp"
#include "cli/reading.hpp"
#include "cli/where.hpp"
#include "cli/words.hpp"
#include "codec/json.hpp"
#include "host/log.hpp"

namespace adit::cli {
namespace {

constexpr std::chrono::seconds kTestPatience{10};
constexpr std::chrono::milliseconds kTestEvery{250};
constexpr int kTestTimes = 480;  // two minutes, far longer than all steps may take

bool has_ended(const api::TestStep& step) {
  return step.state == "good" || step.state == "bad" || step.state == "skipped";
}

std::string line_of(const api::TestStep& step, bool colour) {
  const Tone tone = step.state == "good" ? Tone::Good : step.state == "bad" ? Tone::Bad : Tone::Faint;
  const std::string word = step.state == "bad" ? "BAD" : step.state;
  std::string line =
      "  " + host::escaped(step.name) + std::string(9 - std::min<std::size_t>(step.name.size(), 8), ' ') +
      painted(host::escaped(word), tone, colour) +
      std::string(9 - std::min<std::size_t>(word.size(), 8), ' ') + host::escaped(step.said) + '\n';
  if (!step.advice.empty()) line += std::string(11, ' ') + host::escaped(step.advice) + '\n';
  return line;
}

/// Prints what has ended since it was last called, in the order of the steps.
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
          print_(host::escaped(endpoint.name + " " + endpoint.address) + '\n');
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

/// An aditd that has been restarted in the midst of it knows of none.
bool is_whole(const api::TestView& view) {
  return !view.endpoints.empty() && std::ranges::all_of(view.endpoints, [](const auto& endpoint) {
    return std::ranges::all_of(endpoint.steps, has_ended);
  });
}

using codec::Value;

/// An endpoint to try, as POST /adit/test takes it; null where none is named.
std::expected<Value, std::string> endpoint_to_try(const std::optional<settings::Address>& at,
                                                  const std::string& token_file) {
  Value::Object endpoint;
  if (at) endpoint = {{"address", {at->address}}, {"port", {std::int64_t{at->port}}}};
  if (!token_file.empty()) {
    const auto token = token_in_file(token_file);
    if (!token) return std::unexpected(token.error());
    endpoint.emplace_back("token", Value{token->token.reveal()});
  }
  return endpoint.empty() ? Value{} : Value{std::move(endpoint)};
}

/// The body of POST /adit/test; "" for what is in use.
std::expected<std::string, std::string> body_of(const Trial& trial) {
  if (trial.is_of_what_is_in_use()) return "";
  const auto scoring = endpoint_to_try(trial.scoring, trial.scoring_token);
  if (!scoring) return std::unexpected(scoring.error());
  const auto mapping = endpoint_to_try(trial.mapping, trial.mapping_token);
  if (!mapping) return std::unexpected(mapping.error());
  Value::Object body = {{"scoring", *scoring}, {"mapping", *mapping}};
  if (!trial.course.empty()) body.emplace_back("course", Value{trial.course});
  return codec::write_json({std::move(body)});
}

/// Begins the test. If one is running, test() joins it, provided that it tests the settings in use.
std::expected<void, Outcome> begin(const Adit& adit, const Trial& trial) {
  auto body = body_of(trial);
  if (!body) return std::unexpected(unable(body.error()));
  const auto begun = http_ask(adit.address,
                              {.method = HttpRequest::Method::Post,
                               .target = "/adit/test",
                               .token = adit.token.token,
                               .body = *std::move(body)},
                              kTestPatience);
  if (!begun) return std::unexpected(unable(begun.error().sentence));
  if (begun->status == 200) return {};
  if (begun->status == 409 && trial.is_of_what_is_in_use()) return {};
  return std::unexpected(unable(failure(adit, *begun)));
}

}  // namespace

Outcome test(const Options& options, bool colour, const std::function<void(const std::string&)>& print) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (auto begun = begin(*adit, options.trial); !begun) return std::move(begun.error());
  Progress progress(colour, print);
  for (int i = 0; i < kTestTimes; ++i) {
    const auto json = get(*adit, "/adit/test");
    if (!json) return unable(json.error());
    const auto view = read<api::TestView>(*adit, *json);
    if (!view) return unable(view.error());
    if (view->applied != options.trial.is_of_what_is_in_use())
      return unable("a test of other values is running: try again when it has ended");
    if (view->outdated) return unable("the settings changed during the test: start it again");
    if (!options.json) progress.show(*view);
    if (!view->running) {
      if (options.json) print(*json + '\n');
      if (!is_whole(*view))
        return unable("the test was interrupted, perhaps by a restart of Adit: start it again");
      return {is_bad(*view) ? Exit::Attention : Exit::Fine, "", ""};
    }
    std::this_thread::sleep_for(kTestEvery);
  }
  return unable("the test has not ended after 2 minutes: see journalctl -u adit");
}

}  // namespace adit::cli
