#include "api/network.hpp"

#include <algorithm>

#include "cli/handlers.hpp"
#include "cli/words.hpp"
#include "icd/sentence.hpp"
#include "icd/try.hpp"

namespace adit::cli {
namespace {

constexpr Waiting kConfirming{.within = std::chrono::seconds(5),
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

Result<Outcome> decide_on_network(const Call& call) {
  const bool confirms = call.options.word() == "confirm";
  ADIT_TRY(post(call.adit, {.target = "/adit/network/" + call.options.word(), .check = "adit network"}));
  const auto told = fetch_until<api::NetworkView>(call.adit, "/adit/network", kConfirming,
                                                  [](const api::NetworkView& view) { return !view.pending; });
  // After a revert, the box may no longer have the address that was asked.
  if (!told && !confirms) return printed(call, "{}", "the box is returning to the old addresses\n");
  if (!told) return std::unexpected(told.error());
  const api::NetworkView& view = told->row;
  const bool done = view.last == (confirms ? "confirmed" : "reverted");
  return printed(
      call, told->json,
      line("the change is ", view.last, done || view.last_why.empty() ? "" : ": ", done ? "" : view.last_why),
      done ? Exit::Fine : Exit::Attention);
}

}  // namespace adit::cli
