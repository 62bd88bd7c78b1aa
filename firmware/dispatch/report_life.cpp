#include "dispatch/report_life.hpp"

#include <array>

namespace adit::dispatch {
namespace {

struct Transition {
  ReportState from;
  ReportEvent event;
  ReportState to;
};

constexpr std::array kTransitions = {
    Transition{ReportState::Waiting, ReportEvent::Chosen, ReportState::Sending},
    Transition{ReportState::Waiting, ReportEvent::Restarted, ReportState::Waiting},
    Transition{ReportState::Sending, ReportEvent::Recorded, ReportState::Answered},
    Transition{ReportState::Sending, ReportEvent::Refused, ReportState::Refused},
    Transition{ReportState::Sending, ReportEvent::Throttled, ReportState::Waiting},
    Transition{ReportState::Sending, ReportEvent::NeverLeft, ReportState::Waiting},
    Transition{ReportState::Sending, ReportEvent::Lost, ReportState::InDoubt},
    Transition{ReportState::Sending, ReportEvent::Restarted, ReportState::InDoubt},
    Transition{ReportState::Answered, ReportEvent::Restarted, ReportState::Answered},
    Transition{ReportState::Refused, ReportEvent::Restarted, ReportState::Refused},
    Transition{ReportState::InDoubt, ReportEvent::Restarted, ReportState::InDoubt},
};

struct Name {
  ReportState state;
  std::string_view text;
};

constexpr std::array kNames = {
    Name{ReportState::Waiting, "waiting"},   Name{ReportState::Sending, "sending"},
    Name{ReportState::Answered, "answered"}, Name{ReportState::Refused, "refused"},
    Name{ReportState::InDoubt, "in doubt"},
};

}  // namespace

std::optional<ReportState> next(ReportState state, ReportEvent event) {
  for (const Transition& transition : kTransitions) {
    if (transition.from == state && transition.event == event) return transition.to;
  }
  return std::nullopt;
}

ReportEvent event_of(int status) {
  if (status >= 200 && status < 300) return ReportEvent::Recorded;
  if (status == 429) return ReportEvent::Throttled;
  if (status >= 400 && status < 500) return ReportEvent::Refused;
  return ReportEvent::Lost;
}

bool is_final(ReportState state) {
  return state == ReportState::Answered || state == ReportState::Refused;
}

std::string_view name_of(ReportState state) {
  for (const Name& name : kNames) {
    if (name.state == state) return name.text;
  }
  return "";
}

std::optional<ReportState> state_named(std::string_view text) {
  for (const Name& name : kNames) {
    if (name.text == text) return name.state;
  }
  return std::nullopt;
}

}  // namespace adit::dispatch
