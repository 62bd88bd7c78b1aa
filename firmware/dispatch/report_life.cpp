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

/// What an event is called in the diagram.
std::string_view words(ReportEvent event) {
  switch (event) {
    case Event::Held:
      return "held for the operator";
    case Event::HeldBack:
      return "operator: hold";
    case Event::Released:
      return "operator: send";
    case Event::Chosen:
      return "its turn";
    case Event::Recorded:
      return "2xx";
    case Event::Refused:
      return "4xx";
    case Event::Throttled:
      return "429";
    case Event::Barred:
      return "401, 403, 404, 405, 407";
    case Event::NeverLeft:
      return "no byte left";
    case Event::Lost:
      return "no answer, 3xx, 408, 5xx";
    case Event::Found:
      return "status: recorded";
    case Event::Missing:
      return "status: not recorded";
    case Event::CalledDone:
      return "operator: done";
    case Event::Withdrawn:
      return "operator: withdraw";
    case Event::Joined:
      return "same as an earlier one";
    case Event::Cleared:
      return "another run";
    case Event::Restarted:
      return "restart";
  }
  return "";
}

std::string_view words(ReportAction action) {
  switch (action) {
    case Action::Nothing:
      return "";
    case Action::Send:
      return " / send";
    case Action::AnswerClients:
      return " / answer its clients";
    case Action::TellClients:
      return " / tell its clients";
    case Action::Ask:
      return " / ask the status";
  }
  return "";
}

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

std::string report_life_diagram() {
  std::string text = "stateDiagram-v2\n  state \"in doubt\" as in_doubt\n  [*] --> waiting: posted\n";
  const auto id = [](ReportState state) { return state == InDoubt ? "in_doubt" : name_of(state); };
  for (const ReportTransition& row : kLife) {
    if (row.from == row.to) continue;  // nothing to see
    text.append("  ").append(id(row.from)).append(" --> ").append(id(row.to)).append(": ");
    text.append(words(row.event)).append(words(row.action)).append("\n");
  }
  for (const std::string_view word : kStateWords) {
    const auto state = state_named(word);
    if (is_final(*state)) text.append("  ").append(id(*state)).append(" --> [*]\n");
  }
  return text;
}

}  // namespace adit::dispatch
