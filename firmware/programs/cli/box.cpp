#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <span>

#include "api/clock.hpp"
#include "api/network.hpp"
#include "api/updates.hpp"
#include "cli/handlers.hpp"
#include "cli/table.hpp"
#include "clock/messages.hpp"
#include "icd/sentence.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "loop/loop.hpp"
#include "update/messages.hpp"

namespace adit::cli {
namespace {

constexpr PollPolicy kConfirming{.within = std::chrono::seconds(5),
                                 .every = std::chrono::milliseconds(200),
                                 .late = "the change was confirmed but is still pending: see adit network"};

std::string side_line(const char* name, const std::string& interface, const std::string& addresses,
                      const std::optional<std::uint32_t>& gateway = {}) {
  return line("  ", name, interface.empty() ? "" : "  ", interface, "  ", addresses,
              gateway ? "  gateway " + settings::ipv4_text(*gateway) : "");
}

/// The addresses of both sides. `own`: the team's address.
std::string sides_of(const network::Numbers& numbers, const std::string& own, const std::string& team = "",
                     const std::string& post = "") {
  const std::string mode(network::name_of(numbers.mode));
  return side_line("team        ", team, own.empty() ? mode : mode + "  " + own) +
         side_line("command post", post, network::command_post_text(numbers), numbers.gateway);
}

std::string pending_text(const api::PendingNetwork& pending, double now) {
  const network::Numbers& wanted = pending.wanted;
  return line("") +
         line("A change is to be confirmed within ", duration(std::max(0.0, pending.until - now)), ":") +
         sides_of(wanted, wanted.mode == network::Mode::Static ? network::host_text(wanted.team) : "") +
         line("Confirm it at ", pending.page,
              " (adit network confirm); otherwise the box returns to the old addresses.");
}

std::string text_of(const api::NetworkView& view, bool /*colour*/) {
  const network::Numbers now{.mode = view.mode, .command_post = view.command_post, .gateway = view.gateway};
  std::string out = sides_of(now, view.team ? network::host_text(*view.team) : "none", view.team_interface,
                             view.command_post_interface);
  if (view.pending) {
    out += pending_text(*view.pending, view.now);
  } else if (!view.last.empty()) {
    out += line("") + line("Last change: ", view.last, view.last_why.empty() ? "" : ", ", view.last_why);
  }
  return view.managed ? out : out + line("") + line("Adit cannot change the addresses: ", view.why);
}

}  // namespace

Result<Outcome> show_network(const Call& call) {
  return show<api::NetworkView>(call, "/adit/network", text_of,
                                [](const api::NetworkView& view) { return !view.pending; });
}

namespace {

/// Reads team=, command_post= and gateway= over the present addresses.
Result<void> read_numbers(std::span<const std::string> words, network::Numbers& numbers) {
  for (const std::string& word : words) {
    std::string_view rest = word;
    const std::string_view name = icd::cut(rest, '=');
    const auto wrong = [&](const char* expected) {
      return to_failure(icd::sentence(name, "=: expected ", expected, ", got '", rest, "'"));
    };
    if (name == "team") {
      const auto mode = std::ranges::find(network::kModeWords, rest);
      const auto subnet = settings::parse_subnet(std::string(rest));
      if (!subnet && mode == std::end(network::kModeWords))
        return wrong("an address as 192.168.8.11/24, dhcp or link-local");
      numbers.mode =
          subnet ? network::Mode::Static : static_cast<network::Mode>(mode - std::begin(network::kModeWords));
      numbers.team = subnet.value_or(settings::Subnet());
    } else if (name == "command_post") {
      numbers.command_post.clear();
      while (!rest.empty()) {
        const auto subnet = settings::parse_subnet(std::string(icd::cut(rest, ',')));
        if (!subnet)
          return to_failure("command_post=: expected addresses as 10.100.2.10/24, separated by commas");
        numbers.command_post.push_back(*subnet);
      }
    } else if (name == "gateway") {
      numbers.gateway = settings::ipv4_of(std::string(rest));
      if (!rest.empty() && !numbers.gateway) return wrong("an IPv4 address, or no value for no gateway");
    } else {
      return to_failure("'" + word + "': expected team=, command_post= or gateway=");
    }
  }
  return {};
}

}  // namespace

Result<Outcome> change_network(const Call& call) {
  const auto now = ADIT_TRY(fetch<api::NetworkView>(call.adit, "/adit/network")).row;
  network::Numbers wanted{.mode = now.mode,
                          .team = now.team.value_or(settings::Subnet()),
                          .command_post = now.command_post,
                          .gateway = now.gateway};
  ADIT_TRY(read_numbers(call.options.arguments, wanted));
  const auto changed = ADIT_TRY(read_row_of<api::NetworkView>(
      call.adit,
      post(call.adit, {.target = "/adit/network", .check = "adit network", .body = codec::to_json(wanted)})));
  return print_result(call, changed.json, text_of(changed.row, call.console.colour));
}

Result<Outcome> decide_on_network(const Call& call) {
  const bool confirms = call.options.word() == "confirm";
  ADIT_TRY(post(call.adit, {.target = "/adit/network/" + call.options.word(), .check = "adit network"}));
  const auto told = fetch_until<api::NetworkView>(call.adit, "/adit/network", kConfirming,
                                                  [](const api::NetworkView& view) { return !view.pending; });
  // After a revert, the box may no longer have the address that was asked.
  if (!told && !confirms) return print_result(call, "{}", "the box is returning to the old addresses\n");
  if (!told) return std::unexpected(told.error());
  const api::NetworkView& view = told->row;
  const bool done = view.last == (confirms ? "confirmed" : "reverted");
  return print_result(
      call, told->json,
      line("the change is ", view.last, done || view.last_why.empty() ? "" : ": ", done ? "" : view.last_why),
      done ? Exit::Fine : Exit::Attention);
}

namespace {

constexpr double kAsHere = 2;  // seconds of difference that count as equal

/// In the order of clock::Source.
constexpr std::string_view kSetBy[] = {"not set since boot",          "continued from the last known time",
                                       "set by the robots' stamps",   "set by the Command Post's answers",
                                       "set by the box's clock chip", "set by an operator",
                                       "set by an NTP server"};
static_assert(std::size(kSetBy) == std::size(clock::kSourceWords));

std::string text_of(const api::ClockView& view, bool /*colour*/) {
  const double ahead = view.now - loop::system_now();
  const std::string apart =
      std::abs(ahead) <= kAsHere
          ? "the same as on this computer"
          : icd::sentence(duration(std::abs(ahead)), ahead > 0 ? " ahead of" : " behind", " this computer");
  const std::string date = icd::utc(view.now);
  std::string out = line(date.empty() ? "date unknown" : date + " UTC", ", ", apart);
  out += view.source ? line(kSetBy[static_cast<std::size_t>(*view.source)])
                     : line("Adit cannot set it: ", view.why);
  if (!view.refusal.empty()) out += line("Not set: ", view.refusal);
  if (!view.ntp.empty()) out += line(view.ntp);
  if (!view.is_set && view.managed) out += line("To set it to this computer's time: adit clock set");
  return out;
}

}  // namespace

Result<Outcome> show_clock(const Call& call) {
  return show<api::ClockView>(call, "/adit/clock", text_of,
                              [](const api::ClockView& view) { return view.is_set && view.refusal.empty(); });
}

Result<Outcome> set_clock(const Call& call) {
  return act(call,
             {.target = "/adit/clock",
              .check = "adit clock",
              .body = "{\"time\":" + std::to_string(loop::system_now()) + "}"},
             "the clock is being set\n");
}

namespace {

using api::UpdateView;
using update::Stage;

constexpr const char* kUpdate = "/adit/update";
constexpr const char* kSeeUpdate = "adit update";
/// Allows for a bundle over a slow link.
constexpr std::chrono::minutes kUpload{30};
/// Allows for a slot on a slow card.
constexpr PollPolicy kInstalling{.within = std::chrono::minutes(25),
                                 .every = std::chrono::milliseconds(500),
                                 .late = "the box has not finished: see adit update"};

/// The result of the last update, or "".
std::string last_line(const UpdateView& view) {
  if (view.status.last.stage == Stage::None) return "";
  const std::string name = "update " + view.status.last.version;
  if (view.status.last.stage == Stage::Good) return line(name, " came up healthy");
  if (view.status.trial) return line(name, " is on trial until it has been healthy for a minute");
  if (view.status.last.stage == Stage::Installed)
    return line(name, " is installed: restart to use it (adit update --restart)");
  if (view.status.last.stage == Stage::Installing) return line(name, " is being installed");
  return line(name, " was ", name_of(view.status.last.stage), ": ", view.status.last.why);
}

std::string text_of(const UpdateView& view, bool /*colour*/) {
  if (!view.runs_here && view.newer)
    return view.newer->empty() ? line("apt has no newer version") : newer_lines(view);
  if (!view.managed) return line("This box cannot be updated: ", view.why) + newer_lines(view);
  const update::RunningSystem& running = view.status.running;
  std::string out = line(running.version, " runs, in slot ", running.slot, " (an update goes into slot ",
                         running.other, ") of ", running.compatible);
  if (!view.status.stray.empty())
    out += line("An unexpected slot runs: ", view.status.stray) +
           line("  adit update --back   restart the box into the slot that was good last") +
           line("  adit update --stay   keep the slot that runs");
  if (!view.status.doing.empty()) out += line("The box is ", view.status.doing);
  if (!view.status.refusal.empty()) out += line("The last update was rejected: ", view.status.refusal);
  out += last_line(view);
  if (!view.status.stick_trouble.empty()) out += line("On the stick: ", view.status.stick_trouble);
  return out + newer_lines(view);
}

bool is_fine(const UpdateView& view) {
  const Stage stage = view.status.last.stage;
  const bool has_failed = stage == Stage::Failed || stage == Stage::Left || stage == Stage::Interrupted;
  return !has_failed && (view.managed || (!view.runs_here && view.newer)) && view.status.refusal.empty() &&
         view.status.stray.empty();
}

Result<std::string> read_bundle(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) return to_failure(path + ": cannot be read");
  const auto length = static_cast<std::streamoff>(file.tellg());
  if (length <= 0) return to_failure(path + ": is empty, or not a file");
  if (std::cmp_greater(length, update::kLargestBundle)) return to_failure(path + ": too large for an update");
  std::string bytes(static_cast<std::size_t>(length), '\0');
  file.seekg(0);
  if (!file.read(bytes.data(), length)) return to_failure(path + ": cannot be read");
  return bytes;
}

/// Prints the progress until the box has finished.
Result<Outcome> follow(const Call& call) {
  std::string last;
  const auto told =
      ADIT_TRY(fetch_until<UpdateView>(call.adit, kUpdate, kInstalling, [&](const UpdateView& view) {
        if (view.status.doing.empty()) return true;
        const std::string progress =
            view.status.progress ? icd::sentence(" ", *view.status.progress, " %") : "";
        const std::string now = line(view.status.doing, progress);
        if (!call.options.json && now != last) call.console.print(now);
        last = now;
        return false;
      }));
  const UpdateView& view = told.row;
  return print_result(
      call, told.json,
      view.status.refusal.empty() ? last_line(view) : line("the update was rejected: ", view.status.refusal),
      is_fine(view) ? Exit::Fine : Exit::Attention);
}

Result<Outcome> upload(const Call& call) {
  auto bundle = ADIT_TRY(read_bundle(call.options.argument()));
  if (!call.options.json) call.console.print("sending " + icd::size_text(bundle.size()) + '\n');
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
  if (view.status.stick)
    out += line("On the stick is ", view.status.stick->version, " (", view.status.stick->name,
                "): adit update --stick");
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
