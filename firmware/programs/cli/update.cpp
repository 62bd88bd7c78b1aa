#include <chrono>
#include <fstream>

#include "api/updates.hpp"
#include "cli/handlers.hpp"
#include "cli/words.hpp"
#include "icd/try.hpp"
#include "update/messages.hpp"

namespace adit::cli {
namespace {

using api::UpdateView;
using update::Stage;

constexpr const char* kUpdate = "/adit/update";
constexpr const char* kSeeUpdate = "adit update";
/// Allows for a bundle over a slow link.
constexpr std::chrono::minutes kUpload{30};
/// Allows for a slot on a slow card.
constexpr Waiting kInstalling{.within = std::chrono::minutes(25),
                              .every = std::chrono::milliseconds(500),
                              .late = "the box has not finished: see adit update"};

/// The result of the last update, or "".
std::string last_line(const UpdateView& view) {
  if (view.last.stage == Stage::None) return "";
  const std::string name = "update " + view.last.version;
  if (view.last.stage == Stage::Good) return line(name, " came up healthy");
  if (view.trial) return line(name, " is on trial until it has been healthy for a minute");
  if (view.last.stage == Stage::Installed)
    return line(name, " is installed: restart to use it (adit update --restart)");
  if (view.last.stage == Stage::Installing) return line(name, " is being installed");
  return line(name, " was ", name_of(view.last.stage), ": ", view.last.why);
}

std::string text_of(const UpdateView& view, bool /*colour*/) {
  if (!view.runs_here && view.newer)
    return view.newer->empty() ? line("apt has no newer version") : newer_lines(view);
  if (!view.managed) return line("This box cannot be updated: ", view.why) + newer_lines(view);
  const update::Running& running = view.running;
  std::string out = line(running.version, " runs, in slot ", running.slot, " (an update goes into slot ",
                         running.other, ") of ", running.compatible);
  if (!view.stray.empty())
    out += line("An unexpected slot runs: ", view.stray) +
           line("  adit update --back   restart the box into the slot that was good last") +
           line("  adit update --stay   keep the slot that runs");
  if (!view.doing.empty()) out += line("The box is ", view.doing);
  if (!view.refusal.empty()) out += line("The last update was rejected: ", view.refusal);
  out += last_line(view);
  if (!view.stick_why.empty()) out += line("On the stick: ", view.stick_why);
  return out + newer_lines(view);
}

bool is_fine(const UpdateView& view) {
  const Stage stage = view.last.stage;
  const bool has_failed = stage == Stage::Failed || stage == Stage::Left || stage == Stage::Interrupted;
  return !has_failed && (view.managed || (!view.runs_here && view.newer)) && view.refusal.empty() &&
         view.stray.empty();
}

Result<std::string> read_bundle(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return failed(path + ": cannot be read");
  const auto length = static_cast<std::streamoff>(file.tellg());
  if (length <= 0) return failed(path + ": is empty, or not a file");
  if (std::cmp_greater(length, update::kLargestBundle)) return failed(path + ": too large for an update");
  std::string bytes(static_cast<std::size_t>(length), '\0');
  file.seekg(0);
  if (!file.read(bytes.data(), length)) return failed(path + ": cannot be read");
  return bytes;
}

/// Prints the progress until the box has finished.
Result<Outcome> follow(const Call& call) {
  std::string last;
  const auto told =
      ADIT_TRY(fetch_until<UpdateView>(call.adit, kUpdate, kInstalling, [&](const UpdateView& view) {
        if (view.doing.empty()) return true;
        const std::string progress = view.progress ? icd::sentence(" ", *view.progress, " %") : "";
        const std::string now = line(view.doing, progress);
        if (!call.options.json && now != last) call.console.print(now);
        last = now;
        return false;
      }));
  const UpdateView& view = told.row;
  return printed(call, told.json,
                 view.refusal.empty() ? last_line(view) : line("the update was rejected: ", view.refusal),
                 is_fine(view) ? Exit::Fine : Exit::Attention);
}

Result<Outcome> upload(const Call& call) {
  auto bundle = ADIT_TRY(read_bundle(call.options.argument()));
  if (!call.options.json) call.console.print("sending " + size(bundle.size()) + '\n');
  ADIT_TRY(post(call.adit, {.target = call.options.again ? "/adit/update?again=1" : kUpdate,
                            .check = kSeeUpdate,
                            .body = std::move(bundle),
                            .within = kUpload,
                            .content_type = "application/octet-stream"}));
  return follow(call);
}

}  // namespace

std::string newer_lines(const UpdateView& view) {
  std::string out;
  if (view.stick)
    out += line("On the stick is ", view.stick->version, " (", view.stick->name, "): adit update --stick");
  if (view.newer && !view.newer->empty()) out += line("apt has ", *view.newer, ": apt upgrade");
  if (!view.newer_why.empty()) out += line("The newer version of apt is not known: ", view.newer_why);
  return out;
}

Result<Outcome> update(const Call& call) {
  const Options& options = call.options;
  const auto ask = [&call](const char* target, bool option, const char* body, const char* done) {
    return act(call, {.target = target, .check = kSeeUpdate, .body = option ? body : "{}"}, done);
  };
  constexpr const char* kAnyway = R"({"anyway": true})";
  if (!options.argument().empty()) return upload(call);
  if (options.restart) return ask("/adit/update/restart", options.anyway, kAnyway, "the box restarts\n");
  if (options.back)
    return ask("/adit/update/back", options.anyway, kAnyway,
               "the box restarts into the slot that was good last\n");
  if (options.stay) return ask("/adit/update/stay", false, "", "the box keeps the slot that runs\n");
  if (!options.stick) return show<UpdateView>(call, kUpdate, text_of, is_fine);
  const auto begun = ask("/adit/update/stick", options.again, R"({"again": true})", "");
  return begun ? follow(call) : begun;
}

}  // namespace adit::cli
