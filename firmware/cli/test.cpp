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

}  // namespace

Outcome test(const Options& options, bool colour, const std::function<void(const std::string&)>& print) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  const auto begun =
      http_ask(adit->address,
               {.method = HttpRequest::Method::Post, .target = "/adit/test", .token = adit->token.token},
               kTestPatience);
  if (!begun) return unable(begun.error().sentence);
  if (begun->status == 401) return unable(unknown_token(*adit));
  if (begun->status != 200 && begun->status != 409) {  // 409: one runs already
    const std::string sentence = sentence_in(begun->body);
    return unable("Adit at " + written(adit->address) + " answered " + std::to_string(begun->status) +
                  (sentence.empty() ? " (is that Adit?)" : ": " + sentence));
  }
  Progress progress(colour, print);
  for (int i = 0; i < kTestTimes; ++i) {
    const auto json = get(*adit, "/adit/test");
    if (!json) return unable(json.error());
    const auto view = read<api::TestView>(*adit, *json);
    if (!view) return unable(view.error());
    if (!options.json) progress.show(*view);
    if (!view->running) {
      if (options.json) print(*json + '\n');
      return {is_bad(*view) ? Exit::Attention : Exit::Fine, "", ""};
    }
    std::this_thread::sleep_for(kTestEvery);
  }
  return unable("the test does not end: see journalctl -u adit");
}

}  // namespace adit::cli
