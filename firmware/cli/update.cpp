#include "cli/update.hpp"

#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include "api/updates.hpp"
#include "cli/ask.hpp"
#include "cli/http_client.hpp"
#include "cli/reading.hpp"
#include "cli/words.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"
#include "update/messages.hpp"

namespace adit::cli {
namespace {

/// For a bundle over a slow link, and for a slot of a slow card.
constexpr std::chrono::minutes kUpload{30}, kInstall{25};
constexpr std::chrono::milliseconds kUpdateEvery{500};

using api::UpdateView;
using update::Stage;

/// What became of the last update, or "".
std::string last_line(const UpdateView& view) {
  if (view.last.stage == Stage::None) return "";
  const std::string name = icd::sentence("update ", view.last.version);
  if (view.last.stage == Stage::Good) return icd::sentence(name, " came up healthy\n");
  if (view.trial) return icd::sentence(name, " is on trial until it has been healthy for a minute\n");
  if (view.last.stage == Stage::Installed)
    return icd::sentence(name, " is installed: restart to use it (adit update --restart)\n");
  if (view.last.stage == Stage::Installing) return icd::sentence(name, " is being installed\n");
  return host::escaped(icd::sentence(name, " was ", name_of(view.last.stage), ": ", view.last.why)) + '\n';
}

/// Why an unexpected slot runs, and the two remedies.
std::string stray_lines(const UpdateView& view) {
  return icd::sentence("An unexpected slot runs: ", host::escaped(view.stray),
                       "\n  adit update --back   restart the box into the slot that was good last\n"
                       "  adit update --stay   keep the slot that runs\n");
}

std::string text_of(const UpdateView& view) {
  if (!view.managed) return icd::sentence("This box cannot be updated: ", host::escaped(view.why), "\n");
  const update::Running& running = view.running;
  std::string out = host::escaped(icd::sentence(running.version, " runs, in slot ", running.slot,
                                                " (an update goes into slot ", running.other, ") of ",
                                                running.compatible)) +
                    '\n';
  if (!view.stray.empty()) out += stray_lines(view);
  if (!view.doing.empty()) out += icd::sentence("The box is ", host::escaped(view.doing), "\n");
  if (!view.refusal.empty())
    out += icd::sentence("The last update was rejected: ", host::escaped(view.refusal), "\n");
  out += last_line(view);
  if (view.stick)
    out += host::escaped(icd::sentence("On the stick is ", view.stick->version, " (", view.stick->name,
                                       "): adit update --stick")) +
           '\n';
  if (!view.stick_why.empty()) out += icd::sentence("On the stick: ", host::escaped(view.stick_why), "\n");
  return out;
}

Exit exit_of(const UpdateView& view) {
  const Stage stage = view.last.stage;
  const bool failed = stage == Stage::Failed || stage == Stage::Left || stage == Stage::Interrupted;
  return failed || !view.managed || !view.refusal.empty() || !view.stray.empty() ? Exit::Attention
                                                                                 : Exit::Fine;
}

Outcome show_update(const Adit& adit, const Options& options) {
  const auto json = get(adit, "/adit/update");
  if (!json) return unable(json.error());
  const auto view = read<UpdateView>(adit, *json);
  if (!view) return unable(view.error());
  return {exit_of(*view), options.json ? *json + '\n' : text_of(*view), ""};
}

std::expected<std::string, std::string> read_bundle(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return std::unexpected(path + ": cannot be read");
  const auto length = static_cast<std::streamoff>(file.tellg());
  if (length <= 0) return std::unexpected(path + ": is empty, or not a file");
  if (std::cmp_greater(length, update::kLargestBundle))
    return std::unexpected(path + ": too large for an update");
  std::string bytes(static_cast<std::size_t>(length), '\0');
  file.seekg(0);
  if (!file.read(bytes.data(), length)) return std::unexpected(path + ": cannot be read");
  return bytes;
}

/// Until nothing is done any more.
Outcome follow(const Adit& adit, const Options& options,
               const std::function<void(const std::string&)>& print) {
  std::string told;
  for (const auto until = std::chrono::steady_clock::now() + kInstall;;) {
    const auto json = get(adit, "/adit/update");
    if (!json) return unable(json.error());
    const auto view = read<UpdateView>(adit, *json);
    if (!view) return unable(view.error());
    if (view->doing.empty())
      return {exit_of(*view),
              options.json ? *json + '\n'
              : view->refusal.empty()
                  ? last_line(*view)
                  : icd::sentence("the update was rejected: ", host::escaped(view->refusal), "\n"),
              ""};
    std::string line = icd::sentence(host::escaped(view->doing), "\n");
    if (view->progress) line = icd::sentence(host::escaped(view->doing), " ", *view->progress, " %\n");
    if (!options.json && line != told) print(line);
    told = line;
    if (std::chrono::steady_clock::now() >= until) return unable("the box has not finished: see adit update");
    std::this_thread::sleep_for(kUpdateEvery);
  }
}

Outcome upload(const Adit& adit, const Options& options,
               const std::function<void(const std::string&)>& print) {
  auto bundle = read_bundle(options.file);
  if (!bundle) return unable(bundle.error());
  if (!options.json) print("sending " + size(bundle->size()) + '\n');
  const auto reply = http_ask(adit.address,
                              {.method = HttpRequest::Method::Post,
                               .target = options.again ? "/adit/update?again=1" : "/adit/update",
                               .token = adit.token.token,
                               .body = std::move(*bundle),
                               .content_type = "application/octet-stream"},
                              kUpload);
  if (!reply) return unable(reply.error().sentence);
  if (reply->status != 200) return unable(failure(adit, *reply));
  return follow(adit, options, print);
}

/// What the options ask for: "" nothing.
struct Asked {
  std::string target, body = "{}", done;
};

Asked asked_of(const Options& options) {
  const std::string anyway = options.anyway ? R"({"anyway": true})" : "{}";
  if (options.stick) return {"/adit/update/stick", options.again ? R"({"again": true})" : "{}", ""};
  if (options.restart) return {"/adit/update/restart", anyway, "the box restarts\n"};
  if (options.back)
    return {"/adit/update/back", anyway, "the box restarts into the slot that was good last\n"};
  if (options.stay) return {"/adit/update/stay", "{}", "the box keeps the slot that runs\n"};
  return {};
}

}  // namespace

Outcome update(const Options& options, const std::function<void(const std::string&)>& print) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (!options.file.empty()) return upload(*adit, options, print);
  const Asked asked = asked_of(options);
  if (asked.target.empty()) return show_update(*adit, options);
  const auto body = post(*adit, asked.target, asked.body, "adit update");
  if (!body) return unable(body.error());
  if (options.stick) return follow(*adit, options, print);
  return {Exit::Fine, options.json ? *body + '\n' : asked.done, ""};
}

}  // namespace adit::cli
