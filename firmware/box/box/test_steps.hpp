#pragma once

#include <chrono>
#include <expected>
#include <optional>
#include <string>

#include "api/self_test.hpp"
#include "dispatch/answer_text.hpp"
#include "network/messages.hpp"
#include "settings/settings.hpp"
#include "uplink/connection.hpp"

/// Results of the Test's steps: a state, the finding in words, and advice.
namespace adit::box::steps {

using api::TestStep;

enum class Asked : std::uint8_t { Scoring, Mapping };
const char* name_of(Asked asked);
const settings::Address& address_in(const settings::CommandPost& post, Asked asked);

/// `carrier`: host::carrier(). `interface` "": not set.
TestStep link(const std::string& interface, std::optional<bool> carrier);

/// `own`: host::own_address(); `probed`: adit-network's finding; `not_asked`: why it has none.
TestStep address(const std::string& interface,
                 const std::expected<std::optional<settings::Subnet>, std::string>& own,
                 const std::optional<network::Probed>& probed, const std::string& not_asked);

/// Whether the Command Post is at its own port or at the team's, by the port that finds `sought`, its
/// endpoint or gateway.
TestStep cables(const std::string& interface, const std::string& team, const std::string& sought,
                const std::optional<network::Probed>& probed);

/// `error`: 0 or an errno; `why`: in words.
TestStep reach(const std::string& at, int error, const std::string& why);

/// `slash`: the endpoint redirected to a slash at the end of the path.
TestStep token(Asked asked, const uplink::Outcome& outcome, bool slash = false);
TestStep no_token(Asked asked);
/// The run uses all requests that the endpoint allows.
TestStep no_turn(const std::string& name);

/// By an answer's Date; `now`: the box's time of day.
TestStep clock(std::optional<std::chrono::sys_seconds> date, double now);
/// Without Date: by two readings of the run clock, in seconds.
TestStep run_clock(std::optional<double> first, std::optional<double> second);

TestStep skipped(const std::string& name, const std::string& why);

/// Largest difference that passes.
inline constexpr std::chrono::seconds kOff{2};

}  // namespace adit::box::steps
