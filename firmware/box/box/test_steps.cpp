#include "box/test_steps.hpp"

#include <cerrno>
#include <cmath>

#include "codec/read.hpp"
#include "dispatch/mapping_verdict.hpp"
#include "icd/sentence.hpp"

namespace adit::box::steps {
namespace {

TestStep good(std::string name, std::string said) {
  return {.name = std::move(name), .state = "good", .said = std::move(said), .advice = ""};
}
TestStep bad(std::string name, std::string said, std::string advice) {
  return {.name = std::move(name), .state = "bad", .said = std::move(said), .advice = std::move(advice)};
}

std::string answered(int status, const std::string& body) {
  return icd::sentence("the answer is ", status, ": ", dispatch::answer_text(status, body));
}

/// An error about the empty request shows that the token passed.
bool took_the_token(Asked asked, int status, dispatch::Body body) {
  if (body == dispatch::Body::Other) return false;  // not a Command Post's answer
  if (status >= 200 && status < 300) return true;
  return asked == Asked::Mapping && (status == 400 || status == 415 || status == 422);
}

std::string no_endpoint(Asked asked) {
  return icd::sentence("This is no ", name_of(asked),
                       " endpoint: compare its address and port with those posted; scoring and mapping may "
                       "be exchanged.");
}

}  // namespace

const char* name_of(Asked asked) {
  return asked == Asked::Scoring ? "scoring" : "mapping";
}

const settings::Address& address_in(const settings::CommandPost& post, Asked asked) {
  return asked == Asked::Scoring ? post.scoring : post.mapping;
}

TestStep skipped(const std::string& name, const std::string& why) {
  return {.name = name, .state = "skipped", .said = why, .advice = ""};
}

TestStep link(const std::string& interface, std::optional<bool> carrier) {
  if (interface.empty())
    return skipped("link", "the settings name no command_post.interface: any interface is used");
  if (!carrier) {
    return bad(
        "link", icd::sentence("there is no interface ", interface),
        "Check command_post.interface in the settings; `ip link` on the box's console lists the interfaces.");
  }
  if (*carrier) return good("link", icd::sentence(interface, " has a carrier"));
  return bad(
      "link", icd::sentence(interface, " has no carrier"),
      "Plug the Command Post's cable into the box, check the lights of both plugs, and try another cable.");
}

TestStep address(const std::string& interface,
                 const std::expected<std::optional<settings::Subnet>, std::string>& own,
                 const std::optional<network::Probed>& probed, const std::string& not_asked) {
  if (interface.empty()) return skipped("address", "the settings name no command_post.interface");
  if (!own) return skipped("address", own.error());
  if (!*own) {
    return bad(
        "address", icd::sentence(interface, " has no IPv4 address"),
        "Set an address in the Command Post's subnet, on the page or in the box's network configuration.");
  }
  const std::string conflict = probed && !probed->claimant.empty() ? probed->address : "";
  const std::string has =
      icd::sentence(interface, " has ", conflict.empty() ? network::host_text(**own) : conflict);
  if (!probed)
    return skipped("address", icd::sentence(has, "; not checked for an address conflict: ", not_asked));
  if (!probed->trouble.empty()) {
    return skipped("address",
                   icd::sentence(has, "; could not check for an address conflict: ", probed->trouble));
  }
  if (!probed->own.empty()) {
    return bad("address",
               icd::sentence(has, ", but the box's own ", probed->own, " also answers for this address"),
               "Both cables of the box are in one network: plug each into its own network.");
  }
  if (!probed->claimant.empty()) {
    return bad("address", icd::sentence(has, ", but the machine ", probed->claimant, " has the same address"),
               "Give the box another address on the Command Post's side, or ask its crew which machine has "
               "this address.");
  }
  return good("address", icd::sentence(has, ", without an address conflict"));
}

TestStep cables(const std::string& interface, const std::string& team, const std::string& sought,
                const std::optional<network::Probed>& probed) {
  if (!probed || sought.empty()) return skipped("cables", "could not check which network is at which port");
  if (probed->found_on == interface) return good("cables", icd::sentence(sought, " is at ", interface));
  if (probed->found_on.empty() && !probed->not_sought.empty())
    return skipped("cables",
                   icd::sentence("could not check which network is at which port: ", probed->not_sought));
  if (probed->found_on.empty() || probed->found_on != team) {
    return skipped("cables", icd::sentence("no machine answers for ", sought, " at either port"));
  }
  return bad("cables", icd::sentence(sought, " is not at ", interface, " but at ", team),
             "The Command Post's network is at the team's port: exchange the two cables.");
}

TestStep reach(const std::string& at, int error, const std::string& why) {
  switch (error) {
    case 0:
      if (why.empty()) return good("reach", icd::sentence(at, " accepts a connection"));
      return bad("reach", icd::sentence(at, ": ", why), "Check the endpoint's address.");
    case ECONNREFUSED:
      return bad(
          "reach",
          icd::sentence(at,
                        " refuses the connection: the machine is running, but has no server at that port"),
          "Compare the port with the one posted in the Base Station area, or ask whether the server runs.");
    case ENETUNREACH:
      return bad("reach", icd::sentence("there is no route to ", at),
                 "Compare the box's address and prefix on that side with the endpoint's. If they are in "
                 "different subnets, a gateway is missing.");
    case EHOSTUNREACH:
      return bad("reach", icd::sentence("no machine answers for ", at),
                 "Compare the address with the one posted in the Base Station area, and check where the "
                 "cable leads.");
    case ETIMEDOUT:
      return bad("reach", icd::sentence(at, " does not answer"),
                 "Compare the address with the one posted in the Base Station area. If it is correct, a "
                 "firewall or the server itself does not answer.");
    case ENODEV:
      return bad("reach", why, "Check command_post.interface in the settings.");
    default:
      return bad("reach", icd::sentence(at, ": ", why), "Check the endpoint's address.");
  }
}

TestStep no_token(Asked asked) {
  return bad("token", icd::sentence("there is no ", name_of(asked), " token"),
             "Enter the token from the organisers.");
}

TestStep no_turn(const std::string& name) {
  return skipped(name,
                 "not checked: the run itself uses all requests that the endpoint allows; try again later");
}

TestStep token(Asked asked, const uplink::Outcome& outcome, bool slash) {
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  if (answer == nullptr) {
    const auto* never = std::get_if<uplink::NeverSent>(&outcome);
    return bad(
        "token", never != nullptr ? never->why : std::get<uplink::InDoubt>(outcome).why,
        "The server accepts connections but gave no answer: try again, then ask the Command Post's crew.");
  }
  const int status = answer->status;
  const dispatch::Body body = dispatch::body_of(answer->body);
  const bool is_taken = took_the_token(asked, status, body);
  if (is_taken && asked == Asked::Scoring) {
    if (const auto run = codec::read_run_status(answer->body); !run)
      return bad(
          "token",
          icd::sentence("the answer to GET /api/status is not the status of a run (ICD 5.1): ", run.error()),
          no_endpoint(asked));
  }
  if (is_taken)
    return good("token", icd::sentence("the ", name_of(asked), " token is accepted",
                                       slash ? "; paths end with a slash there" : ""));
  if ((status == 401 || status == 403) && body != dispatch::Body::Other) {
    return bad("token",
               icd::sentence("the ", name_of(asked), " token is rejected; ", answered(status, answer->body)),
               "Enter the token again exactly; scoring and mapping may have different tokens.");
  }
  if (status == 429)
    return skipped("token",
                   "the endpoint got too many requests to check the token: try again in a few seconds");
  if (status >= 500 && status != 501) {
    return skipped("token", icd::sentence("the endpoint failed before it checked the token; ",
                                          answered(status, answer->body)));
  }
  return bad("token", answered(status, answer->body), no_endpoint(asked));
}

TestStep clock(std::optional<std::chrono::sys_seconds> date, double now) {
  if (!date) return skipped("clock", "its answers have no Date");
  // A Date stands for one whole second.
  const double there = static_cast<double>(date->time_since_epoch().count());
  const double ahead = now - std::clamp(now, there, there + 1);
  if (std::abs(ahead) <= static_cast<double>(kOff.count())) {
    return good("clock", "the box's clock agrees with the Command Post's");
  }
  const auto seconds = static_cast<std::int64_t>(std::round(std::abs(ahead)));
  return bad("clock",
             icd::sentence("the box's clock is ", seconds, " s ", ahead > 0 ? "ahead of" : "behind",
                           " the Command Post's"),
             "Set the box's clock: it gives the time stamps of maps and states.");
}

TestStep run_clock(std::optional<double> first, std::optional<double> second) {
  if (!first || !second) return skipped("clock", "its answers have no Date and no run clock");
  if (*second > *first) return good("clock", "its answers have no Date, but the run clock moves");
  return skipped("clock", icd::sentence("its answers have no Date, and the run clock stands at ", *second,
                                        " s: the run has not started, or has ended"));
}

}  // namespace adit::box::steps
