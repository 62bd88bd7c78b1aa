#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <expected>
#include <optional>
#include <string>
#include <string_view>

namespace adit::rehearsal {

/// What is wrong with one request's answer, on purpose. One action at most, and what may go with any.
struct Fault {
  enum class Action : std::uint8_t {
    Behave,
    Drop,
    RecordThenDrop,
    HalfAnswer,
    Reset,
    ResetUnrecorded,
    Garbage,
    Unauthorized,
    TooMany,
    Fail,
    RecordThenFail,
    RepeatAnswer,  // the last good answer to a request of this aim; as a broken proxy has it
    // A page of HTML in place of an answer, as of a captive portal.
    PageOk,
    PageElsewhere,
    PageBad,
    PageUnprocessable,
    // What would end a client that takes a peer at its word.
    LengthHuge,
    ChunkHuge,
    HeaderFlood,
    EndlessBody,
    InterimFlood,
    JsonDeep
  };
  using Seconds = std::chrono::duration<double>;

  Action action = Action::Behave;
  int times = 1;                 // that many requests, one after the other (429=COUNT)
  std::optional<Seconds> lasts;  // from its first request on, all those of its aim
  std::string robot;             // of whose messages alone; "": of all
  bool other_sender = false;
  std::optional<std::int64_t> remaining;  // added to remaining_reports, from then on
  std::optional<Seconds> record_after;
  std::optional<Seconds> answer_after;
  std::optional<int> retry_after;  // seconds, in a header of the answer
  bool clock_stands = false;       // run_clock is what the measured server always says

  /// Whether the request is judged at all.
  bool records() const;
};

/// Reads "record-then-drop", "429=3,retry-after=2", "ok": words with a comma between them. An error is a
/// sentence that names the word.
std::expected<Fault, std::string> read_fault(std::string_view words);

/// The words again, in one order; "ok" where there is nothing wrong.
std::string words_of(const Fault& fault);

}  // namespace adit::rehearsal
