#include "dispatch/report.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "icd/sentence.hpp"
#include "icd/text.hpp"

namespace adit::dispatch {
namespace {

using enum ReportState;
using Event = ReportEvent;
using Action = ReportAction;

constexpr std::array kLife = {
    ReportTransition{Queued, Event::Chosen, Sending, Action::Send},
    ReportTransition{Queued, Event::Held, Held, Action::Nothing},
    ReportTransition{Queued, Event::HeldBack, Held, Action::TellClients},
    ReportTransition{Queued, Event::Joined, Withdrawn, Action::Nothing},
    ReportTransition{Queued, Event::Withdrawn, Withdrawn, Action::TellClients},
    ReportTransition{Queued, Event::Released, Queued, Action::Nothing},
    ReportTransition{Queued, Event::Restarted, Queued, Action::Nothing},

    ReportTransition{Held, Event::Released, Queued, Action::Nothing},
    ReportTransition{Held, Event::Withdrawn, Withdrawn, Action::TellClients},
    ReportTransition{Held, Event::Joined, Withdrawn, Action::Nothing},
    ReportTransition{Held, Event::Corrected, Withdrawn, Action::Nothing},
    ReportTransition{Held, Event::Cleared, Queued, Action::Nothing},
    ReportTransition{Held, Event::UndoOver, Queued, Action::Nothing},
    ReportTransition{Held, Event::Held, Held, Action::Nothing},
    ReportTransition{Held, Event::Restarted, Held, Action::Nothing},

    ReportTransition{Sending, Event::Recorded, Answered, Action::AnswerClients},
    ReportTransition{Sending, Event::Rejected, Rejected, Action::AnswerClients},
    ReportTransition{Sending, Event::Redirected, Queued, Action::Nothing},
    ReportTransition{Sending, Event::Throttled, Queued, Action::Nothing},
    ReportTransition{Sending, Event::Barred, Queued, Action::TellClients},
    ReportTransition{Sending, Event::NeverLeft, Queued, Action::Nothing},
    ReportTransition{Sending, Event::Lost, InDoubt, Action::Ask},
    ReportTransition{Sending, Event::Restarted, InDoubt, Action::Ask},

    ReportTransition{InDoubt, Event::Found, Settled, Action::AnswerClients},
    ReportTransition{InDoubt, Event::Missing, Queued, Action::Nothing},
    ReportTransition{InDoubt, Event::Held, Held, Action::TellClients},
    ReportTransition{InDoubt, Event::Released, Queued, Action::Nothing},
    ReportTransition{InDoubt, Event::Settled, Settled, Action::TellClients},
    ReportTransition{InDoubt, Event::Restarted, InDoubt, Action::Ask},

    ReportTransition{Rejected, Event::Released, Queued, Action::Nothing},
    ReportTransition{Rejected, Event::Restarted, Rejected, Action::Nothing},
    ReportTransition{Withdrawn, Event::Released, Queued, Action::Nothing},
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
  switch (state) {
    case Answered:
    case Rejected:
    case Settled:
    case Withdrawn:
      return true;
    case Held:
    case Queued:
    case Sending:
    case InDoubt:
      break;
  }
  return false;
}

std::optional<ReportState> state_named(std::string_view text) {
  const auto* const word = std::ranges::find(kStateWords, text);
  if (word == std::end(kStateWords)) return std::nullopt;
  return static_cast<ReportState>(word - std::begin(kStateWords));
}

bool is_same(const icd::ArtifactReport& one, const icd::ArtifactReport& other) {
  const auto is_near = [](double a, double b) { return std::abs(a - b) <= kSamePlace; };
  return is_near(one.position.x, other.position.x) && is_near(one.position.y, other.position.y) &&
         is_near(one.position.z, other.position.z) && icd::equals_ignoring_case(one.type, other.type);
}

double distance(const icd::ArtifactReport& one, const icd::ArtifactReport& other) {
  return std::hypot(one.position.x - other.position.x, one.position.y - other.position.y,
                    one.position.z - other.position.z);
}

bool is_near(const icd::ArtifactReport& one, const icd::ArtifactReport& other, double metres) {
  return icd::equals_ignoring_case(one.type, other.type) && distance(one, other) <= metres;
}

std::string describe(const icd::ArtifactReport& report) {
  const auto rounded = [](double metres) { return std::round(metres * 1000) / 1000; };
  const icd::Point& at = report.position;
  return icd::sentence(icd::quote_text(report.type), " at ", rounded(at.x), ", ", rounded(at.y), ", ",
                       rounded(at.z));
}

}  // namespace adit::dispatch
