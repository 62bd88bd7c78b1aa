#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "api/self_test.hpp"
#include "dispatch/said.hpp"
#include "network/messages.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

/// What each step of the Test makes of what was found: its state, what was found in words, and what to do
/// about it.
namespace adit::box::steps {

using api::TestStep;

/// The kinds of endpoint, which are asked differently.
enum class Asked : std::uint8_t { Scoring, Mapping };
const char* name_of(Asked asked);
const settings::Address& address_in(const settings::CommandPost& post, Asked asked);

/// `carrier` as host::carrier() tells it; "" as `interface`: none is set.
TestStep link(const std::string& interface, std::optional<bool> carrier);

/// `own`: the interface's address; `probed`: what adit-network heard; `not_asked`: why it was not asked.
TestStep address(const std::string& interface, const std::optional<settings::Subnet>& own,
                 const std::optional<network::Probed>& probed, const std::string& not_asked);

/// Whether the Command Post is at its own port, or at the team's: by who answers for `sought`, the endpoint
/// or the gateway to it.
TestStep cables(const std::string& interface, const std::string& team, const std::string& sought,
                const std::optional<network::Probed>& probed);

/// How connecting ended: 0 or an errno, and why in words.
TestStep reach(const std::string& at, int error, const std::string& why);

/// Of the answer to a question that changes nothing; `slash`: it was asked with a slash at the end of its
/// path, because the endpoint redirects there.
TestStep token(Asked asked, const uplink::Outcome& outcome, bool slash = false);
TestStep no_token(Asked asked);
/// It was not asked: the run asks as often as the endpoint lets itself be asked.
TestStep no_turn(const std::string& name);

/// By the Date of an answer; `now`: seconds since 1970 on the box's clock.
TestStep clock(std::optional<std::chrono::sys_seconds> date, double now);
/// Where answers have no Date: the run clock, in seconds, asked for twice, so long apart.
TestStep run_clock(std::optional<double> first, std::optional<double> second);

TestStep skipped(const std::string& name, const std::string& why);

/// A clock that is off by more is told.
inline constexpr std::chrono::seconds kOff{2};

}  // namespace adit::box::steps
