#pragma once

#include <chrono>
#include <cstdint>
#include <expected>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include "cli/options.hpp"
#include "codec/row.hpp"
#include "icd/bearer_token.hpp"
#include "icd/try.hpp"
#include "loop/file_descriptor.hpp"
#include "settings/settings.hpp"
#include "uplink/exchange.hpp"

namespace adit::cli {

enum class Exit : int { Fine = 0, Attention = 1, Unable = 2 };

struct Outcome {
  Exit exit = Exit::Fine;
  std::string out, err;
};

/// The terminal or other receiver of the output.
struct Console {
  bool colour = false;
  bool screen = false;  // standard output is a terminal
  /// Prints lines of a long command at once; the rest goes into the Outcome.
  std::function<void(const std::string&)> print = [](const std::string&) {};
  /// Whether the user answers yes; std::nullopt: no user.
  std::function<std::optional<bool>(const std::string&)> ask = [](const std::string&) {
    return std::nullopt;
  };
  /// A secret: at a terminal typed after the question and not shown, else the next line of standard input.
  /// std::nullopt: the input has ended.
  std::function<std::optional<std::string>(const std::string&)> read_secret = [](const std::string&) {
    return std::nullopt;
  };
};

/// The port of ICD 4 and of the example settings.
inline constexpr std::uint16_t kUsualPort = 8000;
/// "10.0.0.1:8000" or "[fd00::1]:8000". `usual`: the port if `text` has none.
std::expected<settings::Address, std::string> parse_address(std::string_view text,
                                                            std::uint16_t usual = kUsualPort);
/// The same; also a host's name ("adit.local:8000"), or a URL of a page ("http://adit.local/setup"), whose
/// default port is 80.
std::expected<settings::Address, std::string> parse_location(std::string_view text);
std::string to_text(const settings::Address& address);

/// The address of an Adit with these settings, from this machine. If it listens at all addresses of
/// team.interface, returns one of them, because a socket bound to the interface does not answer on loopback.
std::expected<settings::Address, std::string> reach(const settings::Team& team);

inline constexpr std::size_t kLargestBody = 8u << 20;
inline constexpr std::chrono::milliseconds kReadPatience{3000};
/// Longer, because an action is on disk before its answer.
inline constexpr std::chrono::milliseconds kActionPatience{10000};

struct Post {
  std::string target;     // "/adit/runs"
  std::string check;      // command that shows whether an action was done, if its answer is lost
  std::string body = "";  // JSON or ""
  std::chrono::milliseconds within = kActionPatience;
  std::string content_type = "application/json";
};
uplink::Request get_request(std::string target);
uplink::Request post_request(Post action);

using HttpReply = uplink::Answered;

struct NoReply {
  std::string sentence;  // with the address
  bool sent = false;     // the request may have arrived
};

/// One blocking request (RFC 9112) on its own connection, with its whole reply, within `within`.
std::expected<HttpReply, NoReply> http_ask(const settings::Address& address, const icd::BearerToken& token,
                                           uplink::Request request, std::chrono::milliseconds within);

/// A request with an endless answer.
class HttpStream {
 public:
  /// Sends the request within `within`. An error names the address.
  static std::expected<std::unique_ptr<HttpStream>, std::string> ask(const settings::Address& address,
                                                                     const icd::BearerToken& token,
                                                                     uplink::Request request,
                                                                     std::chrono::milliseconds within);
  HttpStream(loop::FileDescriptor fd, const uplink::Endpoint& endpoint, const icd::BearerToken& token,
             uplink::Request request);

  /// Readable if there is data or the end.
  int fd() const { return fd_.get(); }

  struct StreamEnd {
    int status = 0;  // of an answer other than 200; 0: the answer was 200, or absent
    std::string why;
  };
  /// The new data of a 200's body. Does not block.
  std::expected<std::string, StreamEnd> read();

 private:
  void read_exchange();

  loop::FileDescriptor fd_;
  uplink::Exchange exchange_;
  std::optional<StreamEnd> ended_;
};

/// Address and token of the Adit that the options select.
struct Adit {
  settings::Address address;
  Token token;
};

struct Failure {
  Exit exit = Exit::Unable;  // Attention: Adit rejected the action, or its target does not exist
  std::string sentence;
  int status = 0;  // of Adit's answer; 0: no answer
};
template <class T>
using Result = std::expected<T, Failure>;

std::unexpected<Failure> to_failure(std::string sentence, Exit exit = Exit::Unable);

/// Context of a command that asks Adit.
struct Call {
  const Adit& adit;
  const Options& options;
  const Console& console;
};

/// The address: --at, which may name a context (contexts.hpp); ADIT_AT; the context in use; the settings. The
/// token: --token-file ("-": Console::read_secret), ADIT_TOKEN_FILE, ADIT_TOKEN, the context's; without a
/// context, the box's own. If there is none, the error says how to name one.
Result<Adit> adit_of(const Options& options, const Console& console = {});
/// A token that is typed or piped. `question`: at a terminal.
Result<icd::BearerToken> read_token(const Console& console, const std::string& question);

/// The body of an answer 200 or 202.
Result<std::string> get(const Adit& adit, const std::string& target,
                        std::chrono::milliseconds within = kReadPatience);

/// The same of an action.
Result<std::string> post(const Adit& adit, Post action);

/// The sentence in an error's body (a JSON string), or "".
std::string sentence_in(const std::string& body);

Result<codec::Value> json_in(const Adit& adit, std::string_view body);
/// Reads the answer into a row of that kind. Error: not an answer of this Adit.
Result<void> read_into(const Adit& adit, const Result<codec::Value>& answer, const codec::RowKind& kind,
                       void* row);

/// Adit's answer as JSON, and as a row or rows.
template <class Row>
struct Fetched {
  std::string json;
  Row row = {};
};
template <class Row>
Result<Fetched<Row>> read_row_of(const Adit& adit, Result<std::string> json) {
  if (!json) return std::unexpected(std::move(json.error()));
  Fetched<Row> told{*std::move(json)};
  ADIT_TRY(read_into(adit, json_in(adit, told.json), codec::kind_of<Row>, &told.row));
  return told;
}
template <class Row>
Result<Fetched<Row>> fetch(const Adit& adit, const std::string& target) {
  return read_row_of<Row>(adit, get(adit, target));
}

/// Time limit and interval of questions for an action's outcome.
struct PollPolicy {
  std::chrono::milliseconds within, every;
  bool may_be_away = false;  // Adit need not answer until then
  const char* late = "";     // the error at the time limit
};
/// Fetches the row until `is_over` returns true for it.
template <class Row, class IsOver>
Result<Fetched<Row>> fetch_until(const Adit& adit, const std::string& target, const PollPolicy& waiting,
                                 IsOver is_over) {
  const auto end = std::chrono::steady_clock::now() + waiting.within;
  while (true) {
    auto answer = fetch<Row>(adit, target);
    if (answer ? is_over(answer->row) : !waiting.may_be_away) return answer;
    if (std::chrono::steady_clock::now() >= end)
      return answer ? Result<Fetched<Row>>(to_failure(waiting.late)) : answer;
    std::this_thread::sleep_for(waiting.every);
  }
}

/// With --json `json` (without its newline), else `text`.
Outcome print_result(const Call& call, const std::string& json, const std::string& text,
                     Exit exit = Exit::Fine);

/// Shows a row of Adit's. The exit status is 1 unless `is_fine`.
template <class Row>
Result<Outcome> show(
    const Call& call, const std::string& target, std::string (*text_of)(const Row& row, bool colour),
    bool (*is_fine)(const Row& row) = [](const Row& /*row*/) { return true; }) {
  const auto answer = ADIT_TRY(fetch<Row>(call.adit, target));
  return print_result(call, answer.json, text_of(answer.row, call.console.colour),
                      is_fine(answer.row) ? Exit::Fine : Exit::Attention);
}

/// Executes an action, and prints Adit's JSON or `done`.
Result<Outcome> act(const Call& call, Post action, const std::string& done);

/// Executes an action for each number in the options, until Adit cannot be asked.
Outcome act_on_each(const Call& call, const std::function<Result<Outcome>(std::int64_t number)>& act_on);

/// Succeeds with --yes, or if the operator confirms. `why`: the reason to ask. `undone`: the error otherwise.
Result<void> confirm(const Options& options, const Console& console, const std::string& why,
                     const std::string& question, const std::string& undone = "it was not done");

/// Error: the file cannot be written.
Result<void> write_to(const std::string& file, const std::string& content);

/// Prints the failure on standard error.
Outcome failure_outcome(const Failure& failure);

}  // namespace adit::cli
