#include "cli/network.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

#include "cli/ask.hpp"
#include "cli/http_client.hpp"
#include "cli/reading.hpp"
#include "cli/where.hpp"
#include "cli/words.hpp"
#include "host/log.hpp"
#include "icd/sentence.hpp"

namespace adit::cli {
namespace {

constexpr std::chrono::seconds kConfirmPatience{10};
/// How often, and how many times, Adit is asked what became of a word: for 5 s.
constexpr std::chrono::milliseconds kConfirmEvery{200};
constexpr int kConfirmTimes = 25;

struct Side {
  std::string interface, addresses, gateway;
};

/// What `adit network` shows of GET /adit/network.
struct View {
  bool managed = false;
  std::string why;
  Side team, post;
  bool pending = false;
  double left = 0;  // seconds, by the box's clock
  std::string page;
  Side wanted_team, wanted_post;
  std::string last, last_why;
};

std::string host_in(const codec::Field& side) {
  return text(side, "address") + '/' + std::to_string(whole<std::int64_t>(side, "prefix"));
}

/// "static  192.168.7.11/24", "dhcp  none"; of what is wanted, "dhcp" alone. What the box has: `is_shown`.
Side read_team(const codec::Field& side, bool is_shown) {
  const std::string mode = text(side, "mode");
  const bool none = side.member("address").is_absent();
  const std::string addresses = none ? (is_shown ? "none" : "") : host_in(side);
  return {.interface = is_shown ? text(side, "interface") : "",
          .addresses = addresses.empty() ? mode : mode + "  " + addresses,
          .gateway = ""};
}

/// "10.100.1.10/24, 10.100.2.10/24", "none"
Side read_post(const codec::Field& side, bool is_shown) {
  const codec::Field list = side.member("addresses");
  std::string addresses;
  for (std::size_t i = 0; i < list.size(); ++i) {
    addresses.append(i == 0 ? "" : ", ").append(host_in(list.element(i)));
  }
  return {.interface = is_shown ? text(side, "interface") : "",
          .addresses = addresses.empty() ? "none" : addresses,
          .gateway = text(side, "gateway")};
}

View read_view(const codec::Field& root) {
  const codec::Field team = root.member("team"), post = root.member("command_post"),
                     pending = root.member("pending"), last = root.member("last");
  View view;
  view.managed = root.member("managed").truth();
  view.why = text(root, "why");
  view.team = read_team(team, true);
  view.post = read_post(post, true);
  view.last = last.is_absent() ? "" : std::string(last.text());
  view.last_why = text(root, "last_why");
  view.pending = !pending.is_absent();
  if (!view.pending) return view;
  const codec::Field wanted_team = pending.member("team"), wanted_post = pending.member("command_post");
  view.left = number(pending, "until") - number(root, "now");
  view.page = text(pending, "page");
  view.wanted_team = read_team(wanted_team, false);
  view.wanted_post = read_post(wanted_post, false);
  return view;
}

std::string side_line(const char* name, const Side& side) {
  const std::string interface = side.interface.empty() ? "" : icd::sentence("  ", side.interface);
  const std::string gateway = side.gateway.empty() ? "" : icd::sentence("  gateway ", side.gateway);
  return host::escaped(icd::sentence("  ", name, interface, "  ", side.addresses, gateway)) + '\n';
}

std::string text_of(const View& view) {
  std::string out = side_line("team        ", view.team) + side_line("command post", view.post);
  if (view.pending) {
    out += icd::sentence("\nA change is to be confirmed within ", duration(std::max(0.0, view.left)), ":\n");
    out += side_line("team        ", view.wanted_team) + side_line("command post", view.wanted_post);
    out += icd::sentence("Confirm it at ", host::escaped(view.page),
                         " (adit network confirm); otherwise the box returns to the old addresses.\n");
  } else if (!view.last.empty()) {
    const std::string why = view.last_why.empty() ? "" : icd::sentence(", ", view.last_why);
    out += icd::sentence("\nLast change: ", host::escaped(view.last + why), "\n");
  }
  if (!view.managed)
    out += icd::sentence("\nAdit cannot change the addresses: ", host::escaped(view.why), "\n");
  return out;
}

std::expected<View, std::string> understood(const Adit& adit, const std::string& json) {
  return read<View>(adit, json, read_view);
}

Outcome show_network(const Adit& adit, const Options& options) {
  const auto json = get(adit, "/adit/network");
  if (!json) return unable(json.error());
  const auto view = understood(adit, *json);
  if (!view) return unable(view.error());
  const Exit exit = view->pending ? Exit::Attention : Exit::Fine;
  return {exit, options.json ? *json + '\n' : text_of(*view), ""};
}

/// Confirms or reverts the change, and waits for the result. After a revert the box may no longer have the
/// address that adit asked.
Outcome say(const Adit& adit, const Options& options, bool confirms) {
  const auto reply = http_ask(adit.address,
                              {.method = HttpRequest::Method::Post,
                               .target = confirms ? "/adit/network/confirm" : "/adit/network/revert",
                               .token = adit.token.token},
                              kConfirmPatience);
  if (!reply) return unable(reply.error().sentence);
  if (reply->status != 200) return unable(failure(adit, *reply));
  for (int i = 0; i < kConfirmTimes; ++i) {
    const auto json = get(adit, "/adit/network");
    if (!json && !confirms) break;
    if (!json) return unable(json.error());
    const auto view = understood(adit, *json);
    if (!view) return unable(view.error());
    if (!view->pending) {
      const bool done = view->last == (confirms ? "confirmed" : "reverted");
      std::string line =
          "the change is " + view->last + (done || view->last_why.empty() ? "" : ": " + view->last_why);
      return {done ? Exit::Fine : Exit::Attention, options.json ? *json + '\n' : host::escaped(line) + '\n',
              ""};
    }
    std::this_thread::sleep_for(kConfirmEvery);
  }
  if (!confirms)
    return {Exit::Fine, options.json ? "{}\n" : "the box is returning to the old addresses\n", ""};
  return unable("the change was confirmed but is still pending: see adit network");
}

}  // namespace

Outcome network(const Options& options) {
  const auto adit = adit_of(options);
  if (!adit) return unable(adit.error());
  if (options.verb == Verb::Show) return show_network(*adit, options);
  return say(*adit, options, options.verb == Verb::Confirm);
}

}  // namespace adit::cli
