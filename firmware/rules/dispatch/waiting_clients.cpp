#include "dispatch/waiting_clients.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "icd/sentence.hpp"

namespace adit::dispatch {
namespace {

constexpr const char* kAskAgain =
    "; post the same report again to ask for its state; Adit never sends it twice";
constexpr const char* kOldRun = "; it is of an earlier run; post it again to send it in the present run";

}  // namespace

void WaitingClients::carry_on(WaitingClients& before) {
  clients_ = std::exchange(before.clients_, {});
  posted_at_ = std::exchange(before.posted_at_, {});
}

bool WaitingClients::is_young(const Report& report, Instant now) const {
  const auto posted = posted_at_.find(report.number);
  return posted != posted_at_.end() && now - posted->second < kYoung;
}

template <class Which>
void WaitingClients::tell_those(Which which) {
  std::vector<std::pair<ClientId, std::int64_t>> told;
  std::erase_if(clients_, [&](const auto& item) {
    const bool out = which(item.second);
    if (out) told.emplace_back(item.first, item.second.number);
    return out;
  });
  for (const auto& [client, number] : told) tell(client, book_.at(number));
}

void WaitingClients::tell_all(std::int64_t number) {
  tell_those([number](const Client& client) { return client.number == number; });
}

void WaitingClients::hand_over(std::int64_t number, const Report& earlier) {
  for (auto& [id, client] : clients_) {
    if (client.number == number) client.number = earlier.number;
  }
  if (is_final(earlier.state)) return tell_all(earlier.number);
  if (const auto posted = posted_at_.find(number); posted != posted_at_.end()) {
    Instant& at = posted_at_.try_emplace(earlier.number, posted->second).first->second;
    at = std::max(at, posted->second);
  }
}

void WaitingClients::tick(Instant now) {
  tell_those([now](const Client& client) { return client.deadline <= now; });
  std::erase_if(posted_at_, [now](const auto& item) { return now - item.second > kYoung; });
}

void WaitingClients::dismiss(bool all) {
  stopping_ = true;
  const Report* const sending = all ? nullptr : book_.sending();
  tell_those(
      [sending](const Client& client) { return sending == nullptr || client.number != sending->number; });
}

std::optional<std::int64_t> WaitingClients::awaited_by(ClientId client) const {
  const auto found = clients_.find(client);
  return found == clients_.end() ? std::nullopt : std::optional(found->second.number);
}

std::optional<Instant> WaitingClients::next_deadline() const {
  if (clients_.empty()) return std::nullopt;
  const auto first =
      std::ranges::min_element(clients_, {}, [](const auto& item) { return item.second.deadline; });
  return first->second.deadline;
}

void WaitingClients::tell(ClientId client, const Report& report) {
  const std::string name = icd::sentence("report ", report.number);
  const std::string why = report.note.empty() ? "" : " (" + report.note + ")";
  const char* const again = account_.is_of_run(report) ? kAskAgain : kOldRun;
  ClientAnswer answer{.number = report.number};
  switch (report.state) {
    case ReportState::Answered:
    case ReportState::Rejected:
      break;  // stored answer
    case ReportState::Settled:
      if (report.reconciled) break;
      answer.status = icd::Status::Conflict;
      answer.sentence = name + " was settled by the operator; its answer is not known" + why +
                        "; to send it again, post it with the header Adit-Resubmit: yes";
      break;
    case ReportState::Withdrawn:
      answer.status = icd::Status::Conflict;
      answer.sentence = name + " was withdrawn by the operator and is not sent" + why +
                        "; to send it, post it with the header Adit-Resubmit: yes";
      break;
    case ReportState::Held:
      answer.sentence = name + " is held until the operator decides" + why + again;
      break;
    case ReportState::InDoubt:
      answer.status = icd::Status::GatewayTimeout;
      answer.sentence = name + " is in doubt: it may or may not have been recorded" + why + again;
      break;
    case ReportState::Queued:
      answer.sentence = (stopping_ ? "aditd is stopping; " : "") + name + " is queued" + why + again;
      break;
    case ReportState::Sending:
      answer.status = icd::Status::GatewayTimeout;
      answer.sentence = name + " is in flight, and may or may not have been recorded yet" + again;
      break;
  }
  output_.tell(client, answer, report);
}

}  // namespace adit::dispatch
