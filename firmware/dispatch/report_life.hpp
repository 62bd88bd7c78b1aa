#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace adit::dispatch {

/// Where an artifact report is in its life (promise 1). The words of name_of() are what the ledger holds.
enum class ReportState : std::uint8_t {
  Waiting,   // on disk; to be sent when its turn comes
  Sending,   // the next thing that happens is that its bytes leave
  Answered,  // the Command Post recorded it and said so
  Refused,   // the Command Post said that it did not record it, and that asking again is no use
  InDoubt,   // its bytes may have left and no answer is known; only evidence or the operator moves it on
};

enum class ReportEvent : std::uint8_t {
  Chosen,     // its turn has come
  Recorded,   // answered 2xx
  Refused,    // answered 4xx: the Command Post will not have it
  Throttled,  // answered 429: not recorded, may be sent again
  NeverLeft,  // no byte of it was given to the kernel
  Lost,       // bytes may have left, and no answer that means anything came
  Restarted,  // this program began anew and found it so
};

/// The one table of a report's life; nothing where the event cannot happen in that state.
std::optional<ReportState> next(ReportState state, ReportEvent event);

/// What an HTTP status says of a report. A 5xx may come from something in between: it is Lost.
ReportEvent event_of(int status);

/// Nothing more will happen to it by itself.
bool is_final(ReportState state);

std::string_view name_of(ReportState state);
std::optional<ReportState> state_named(std::string_view name);

}  // namespace adit::dispatch
