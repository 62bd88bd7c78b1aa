#include "dispatch/report_life.hpp"

#include <algorithm>
#include <array>
#include <iterator>

namespace adit::dispatch {
namespace {

using enum ReportState;
using Event = ReportEvent;
using Action = ReportAction;

constexpr std::array kLife = {
    ReportTransition{Waiting, Event::Chosen, Sending, Action::Send},
    ReportTransition{Waiting, Event::Held, Received, Action::Nothing},
    ReportTransition{Waiting, Event::HeldBack, Received, Action::TellClients},
    ReportTransition{Waiting, Event::Joined, Withdrawn, Action::Nothing},
    ReportTransition{Waiting, Event::Withdrawn, Withdrawn, Action::TellClients},
    ReportTransition{Waiting, Event::Released, Waiting, Action::Nothing},
    ReportTransition{Waiting, Event::Restarted, Waiting, Action::Nothing},

    ReportTransition{Received, Event::Released, Waiting, Action::Nothing},
    ReportTransition{Received, Event::Withdrawn, Withdrawn, Action::TellClients},
    ReportTransition{Received, Event::Joined, Withdrawn, Action::Nothing},
    ReportTransition{Received, Event::Cleared, Waiting, Action::Nothing},
    ReportTransition{Received, Event::Held, Received, Action::Nothing},
    ReportTransition{Received, Event::Restarted, Received, Action::Nothing},

    ReportTransition{Sending, Event::Recorded, Answered, Action::AnswerClients},
    ReportTransition{Sending, Event::Refused, Refused, Action::AnswerClients},
    ReportTransition{Sending, Event::Throttled, Waiting, Action::Nothing},
    ReportTransition{Sending, Event::Barred, Waiting, Action::TellClients},
    ReportTransition{Sending, Event::NeverLeft, Waiting, Action::Nothing},
    ReportTransition{Sending, Event::Lost, InDoubt, Action::Ask},
    ReportTransition{Sending, Event::Restarted, InDoubt, Action::Ask},

    ReportTransition{InDoubt, Event::Found, Settled, Action::AnswerClients},
    ReportTransition{InDoubt, Event::Missing, Waiting, Action::Nothing},
    ReportTransition{InDoubt, Event::Held, Received, Action::TellClients},
    ReportTransition{InDoubt, Event::Released, Waiting, Action::Nothing},
    ReportTransition{InDoubt, Event::CalledDone, Settled, Action::TellClients},
    ReportTransition{InDoubt, Event::Restarted, InDoubt, Action::Ask},

    ReportTransition{Refused, Event::Released, Waiting, Action::Nothing},
    ReportTransition{Refused, Event::Restarted, Refused, Action::Nothing},
    ReportTransition{Withdrawn, Event::Released, Waiting, Action::Nothing},
    ReportTransition{Withdrawn, Event::Restarted, Withdrawn, Action::Nothing},
    ReportTransition{Answered, Event::Restarted, Answered, Action::Nothing},
    ReportTransition{Settled, Event::Restarted, Settled, Action::Nothing},
};

}  // namespace

std::span<const ReportTransition> report_life() {
  return kLife;
}

const ReportTransition* transition(ReportState state, ReportEvent event) {
  for (const ReportTransition& row : kLife) {
    if (row.from == state && row.event == event) return &row;
  }
  return nullptr;
}

bool is_final(ReportState state) {
  return state == Answered || state == Refused || state == Settled || state == Withdrawn;
}

std::optional<ReportState> state_named(std::string_view text) {
  const auto* const word = std::ranges::find(kStateWords, text);
  if (word == std::end(kStateWords)) return std::nullopt;
  return static_cast<ReportState>(word - std::begin(kStateWords));
}

}  // namespace adit::dispatch
