#include "box/test_steps.hpp"

#include <cerrno>
#include <cmath>

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
  return icd::sentence("the answer is ", status, ": ", dispatch::said(status, body));
}

/// The mapping endpoint is asked an empty question, so that what is wrong is the question: it has got past
/// the token.
bool took_the_token(Asked asked, int status, dispatch::Body body) {
  if (body == dispatch::Body::Other) return false;  // a page is no answer of a Command Post
  if (status >= 200 && status < 300) return true;
  return asked == Asked::Mapping && (status == 400 || status == 415 || status == 422);
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
  if (interface.empty()) return skipped("link", "the settings name no command_post.interface: any is used");
  if (!carrier) {
    return bad("link", icd::sentence("there is no interface ", interface),
               "Look at command_post.interface in the settings; `ip link` on the box's console lists what "
               "there is.");
  }
  if (*carrier) return good("link", icd::sentence(interface, " has a carrier"));
  return bad(
      "link", icd::sentence(interface, " has no carrier"),
      "Plug the Command Post's cable into the box, look at the lights of both plugs, and try another cable.");
}

TestStep address(const std::string& interface, const std::optional<settings::Subnet>& own,
                 const std::optional<network::Probed>& probed, const std::string& not_asked) {
  if (interface.empty()) return skipped("address", "the settings name no command_post.interface");
  if (!own) {
    return bad("address", icd::sentence(interface, " has no IPv4 address"),
               "Set one in the Command Post's subnet, on the page or where the box's network is set up.");
  }
  const std::string conflict = probed && !probed->claimant.empty() ? probed->address : "";
  const std::string has =
      icd::sentence(interface, " has ", conflict.empty() ? network::host_text(*own) : conflict);
  if (!probed)
    return skipped("address", icd::sentence(has, "; whether anybody else has it was not asked: ", not_asked));
  if (!probed->trouble.empty()) {
    return skipped("address",
                   icd::sentence(has, "; whether anybody else has it could not be asked: ", probed->trouble));
  }
  if (!probed->own.empty()) {
    return bad(
        "address", icd::sentence(has, ", and the box's own ", probed->own, " answers for it there"),
        "Both cables of the box are in one network: plug them into the two networks that they belong to.");
  }
  if (!probed->claimant.empty()) {
    return bad("address", icd::sentence(has, ", and so has the machine ", probed->claimant),
               "Give the box another address on the Command Post's side, or ask its crew who has this one.");
  }
  return good("address", icd::sentence(has, ", and nobody else has it"));
}

TestStep cables(const std::string& interface, const std::string& team, const std::string& sought,
                const std::optional<network::Probed>& probed) {
  if (!probed || sought.empty())
    return skipped("cables", "nobody could be asked which network is at which port");
  if (probed->found_on == interface) return good("cables", icd::sentence(sought, " is at ", interface));
  if (probed->found_on.empty() || probed->found_on != team) {
    return skipped("cables", icd::sentence("nobody answers for ", sought, " at either port"));
  }
  return bad("cables", icd::sentence(sought, " is not at ", interface, " but at ", team),
             "The Command Post's network is at the team's port: exchange the two cables.");
}

TestStep reach(const std::string& at, int error, const std::string& why) {
  switch (error) {
    case 0:
      if (why.empty()) return good("reach", icd::sentence(at, " takes a connection"));
      return bad("reach", icd::sentence(at, ": ", why), "Look at the endpoint's address.");
    case ECONNREFUSED:
      return bad(
          "reach",
          icd::sentence(at, " refuses the connection: the machine is there, but no server at that port"),
          "Compare the port with what is posted in the Base Station area, or ask whether the server runs.");
    case ENETUNREACH:
      return bad("reach", icd::sentence("there is no way to ", at),
                 "Compare the box's address and prefix on that side with the endpoint's; if they are in "
                 "different subnets, "
                 "a gateway is missing.");
    case EHOSTUNREACH:
      return bad("reach", icd::sentence("no machine answers for ", at),
                 "Compare the address with what is posted in the Base Station area, and look whether the "
                 "cable leads there.");
    case ETIMEDOUT:
      return bad("reach", icd::sentence(at, " does not answer"),
                 "Compare the address with what is posted in the Base Station area; if it is right, a "
                 "firewall or the "
                 "server itself is silent.");
    case ENODEV:
      return bad("reach", why, "Look at command_post.interface in the settings.");
    default:
      return bad("reach", icd::sentence(at, ": ", why), "Look at the endpoint's address.");
  }
}

TestStep no_token(Asked asked) {
  return bad("token", icd::sentence("there is no ", name_of(asked), " token"),
             "Enter the token that the organisers gave.");
}

TestStep no_turn(const std::string& name) {
  return skipped(name, "not asked: the run itself asks as often as the endpoint allows; try again later");
}

TestStep token(Asked asked, const uplink::Outcome& outcome, bool slash) {
  const auto* answer = std::get_if<uplink::Answered>(&outcome);
  if (answer == nullptr) {
    const auto* never = std::get_if<uplink::NeverSent>(&outcome);
    return bad(
        "token", never != nullptr ? never->why : std::get<uplink::InDoubt>(outcome).why,
        "The server takes connections but gave no answer: try again, then ask the Command Post's crew.");
  }
  const int status = answer->status;
  const dispatch::Body body = dispatch::body_of(answer->body);
  if (took_the_token(asked, status, body))
    return good("token", icd::sentence("the ", name_of(asked), " token is taken",
                                       slash ? "; paths end with a slash there" : ""));
  if ((status == 401 || status == 403) && body != dispatch::Body::Other) {
    return bad("token",
               icd::sentence("the ", name_of(asked), " token is refused; ", answered(status, answer->body)),
               "Enter the token again, to the letter; scoring and mapping may have different ones.");
  }
  if (status == 429)
    return skipped("token", "the endpoint was asked too often to say: try again in a few seconds");
  if (status >= 500 && status != 501) {
    return skipped("token", icd::sentence("the endpoint failed before it said anything of the token; ",
                                          answered(status, answer->body)));
  }
  return bad("token", answered(status, answer->body),
             icd::sentence("This is no ", name_of(asked),
                           " endpoint: compare its address and port with what is posted; "
                           "scoring and mapping may be exchanged."));
}

TestStep clock(std::optional<std::chrono::sys_seconds> date, double now) {
  if (!date) return skipped("clock", "its answers tell no time");
  // The Date is a whole second that has begun: anything up to one second later is the same time.
  const double there = static_cast<double>(date->time_since_epoch().count());
  const double ahead = now < there ? now - there : now > there + 1 ? now - there - 1 : 0;
  if (std::abs(ahead) <= static_cast<double>(kOff.count())) {
    return good("clock", "the box's clock agrees with the Command Post's");
  }
  const auto seconds = static_cast<std::int64_t>(std::round(std::abs(ahead)));
  return bad("clock",
             icd::sentence("the box's clock is ", seconds, " s ", ahead > 0 ? "ahead of" : "behind",
                           " the Command Post's"),
             "Set the box's clock: the stamps of maps and states are by it.");
}

TestStep run_clock(std::optional<double> first, std::optional<double> second) {
  if (!first || !second) return skipped("clock", "its answers tell no time, and no run clock");
  if (*second > *first) return good("clock", "its answers tell no time, but the run clock moves");
  return skipped("clock", icd::sentence("its answers tell no time, and the run clock stands at ", *second,
                                        " s: the run has not begun, or is over"));
}

}  // namespace adit::box::steps
