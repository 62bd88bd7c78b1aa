#include "cli/report_verbs.hpp"

#include "dispatch/report_life.hpp"

namespace adit::cli {

std::vector<std::string_view> verbs_for(const api::ReportRow& report) {
  using dispatch::ReportEvent;
  const auto state = dispatch::state_named(report.state);
  if (!state) return {};
  std::vector<std::string_view> verbs;
  const auto offer = [&verbs](bool possible, std::string_view verb) {
    if (possible) verbs.push_back(verb);
  };
  offer(dispatch::transition(*state, ReportEvent::Released) != nullptr, "send");
  offer(dispatch::transition(*state, ReportEvent::HeldBack) != nullptr, "hold");
  offer(dispatch::transition(*state, ReportEvent::Withdrawn) != nullptr, "withdraw");
  offer(dispatch::transition(*state, ReportEvent::Settled) != nullptr, "settle");
  offer(dispatch::is_final(*state), "resubmit");
  return verbs;
}

}  // namespace adit::cli
