// adit-rehearsal: a Command Post to rehearse against.

#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "command_line/program.hpp"
#include "command_line/read.hpp"
#include "icd/sentence.hpp"
#include "icd/status.hpp"
#include "icd/text.hpp"
#include "icd/try.hpp"
#include "rehearsal/command_post/record.hpp"
#include "rehearsal/command_post/run.hpp"
#include "rehearsal/command_post/server.hpp"
#include "rehearsal/common.hpp"

namespace adit::rehearsal {
namespace {

struct Options {
  Address scoring;
  Address mapping;
  std::optional<Address> control;
  std::string secrets;
  std::string artifacts;   // "": none
  std::string transcript;  // "": none
  std::uint64_t transcript_megabytes = 2000;
  Manner manner = Manner::Strict;
  bool slash = false;           // each path has to end with one
  bool serial = false;          // each endpoint serves one connection at a time
  std::size_t limit_bytes = 0;  // of a body; 0: only the endpoints' own limits
  RunPlan run;
  std::optional<double> rate;            // Hz; absent: by the manner
  bool one_api_limit = false;            // over statuses and reports together
  std::optional<RateBasis> counted;      // how the mapping rate is measured; absent: by the manner
  double link = 0;                       // Mbit/s over both endpoints; 0: no limit
  std::vector<std::string> roster;       // the robots' names; empty: any
  std::vector<std::string> faults;       // "reports:record-then-drop", not yet understood
  std::vector<std::string> fault_rates;  // "reports:record-then-drop=0.1", not yet understood
  std::uint64_t seed = 1;                // of what happens at random
  bool not_started = false;
  bool verbose = false;
  bool help = false, version = false;
};

/// The tokens that the two endpoints know the team by.
struct Secrets {
  std::string scoring;
  std::string mapping;
};

/// A Command Post without its sockets: endpoints, run, record and transcript. Thread-safe.
class CommandPost {
 public:
  /// `transcript` may be null.
  CommandPost(const Options& options, const Secrets& secrets, std::vector<Artifact> artifacts,
              std::unique_ptr<Transcript> transcript);

  /// Each decides the outcome of a request to that endpoint and records it, before a byte is sent.
  /// The request has to outlive the outcome, which may be decided later.
  Outcome scoring(const Request& request);
  Outcome mapping(const Request& request);

  /// The control port (README.md, 'The control port'). POST /posted of adit-robots: Arrivals::set_expected.
  Outcome control(const Request& request);

  Faults& faults() { return faults_; }
  std::string summary() const { return record_.summary(run_.standing(Clock::now())) + arrivals_.table(); }
  std::string killed_by() const { return record_.killed_by(); }

 private:
  struct Side {
    std::unique_ptr<Endpoint> endpoint;
    const char* name;
  };

  bool redirects(const Request& request) const;
  bool is_too_large(const Request& request) const {
    return options_.limit_bytes > 0 && !request.fault && request.body.size() > options_.limit_bytes;
  }
  void note_order(const Request& request, const Fault& fault, Judgement& judgement);
  void check_names(Judgement& judgement) const;
  Outcome last_answer_to(Aim aim);
  void note_answer(Aim aim, const Outcome& outcome);
  Outcome receive(Side& side, std::optional<Aim> aim, const Request& request);
  Judgement judge(Side& side, std::optional<Aim> aim, const Fault& fault, const Request& request);
  Outcome decide(Side& side, std::optional<Aim> aim, const Fault& fault, const Request& request);
  /// Another sender on the same token submits a report; if `sent` holds nothing, one that no artifact is
  /// near. `sent`: numbers x, y, z and a text type. Gives the report as it was recorded.
  OrderedJson report_from_another_sender(const std::optional<Json>& sent);
  Outcome show_arrivals() const;
  OrderedJson record() const;
  void keep(OrderedJson report, const char* by, const OrderedJson& request);
  void show(std::uint64_t number, const Request& request, const Judgement& judgement) const;

  const Options options_;
  Run run_;
  Record record_;
  Faults faults_;
  Arrivals arrivals_;
  Side scoring_;
  Side mapping_;
  std::unique_ptr<Transcript> transcript_;
  /// Held from the moment at which the run counts a report until the record and the transcript have it, and
  /// while a status is answered. No status therefore counts a report that the record does not have.
  mutable std::mutex scoring_mutex_;
  std::mutex answers_mutex_;
  std::array<std::optional<Answer>, kAims.size()> answers_;  // the last good one of each aim
  std::optional<Clock::time_point> reported_;  // when the last report that was answered had arrived
  std::atomic<std::uint64_t> number_;
  std::atomic<int> by_others_ = 0;
};

/// After it the connection ends.
Outcome last_answer(Outcome outcome) {
  outcome.after = ConnectionAction::Close;
  return outcome;
}

/// All endpoints refuse bytes that are no HTTP request in the same way. A request that its sender broke off,
/// or that came too slowly, is recorded, but breaks no rule of the ICD.
Judgement judge_fault(const HttpFault& fault) {
  constexpr int timeout = 408;
  Judgement judgement;
  if (fault.status != 0 && fault.status != timeout) {
    judgement.findings.add_violation(fault.sentence, Measured::Refuses, fault.status);
  }
  judgement.outcome = last_answer(answer_refusal(fault.status, fault.sentence));
  return judgement;
}

/// The aim of a request to either endpoint, if it has one. As measured, slashes may end the path.
std::optional<Aim> scoring_aim(const Request& request, Manner manner) {
  std::string_view path = request.path;
  if (manner == Manner::AsMeasured) path = strip_slash(path);
  if (request.fault) return std::nullopt;
  if (request.method == "POST" && path == kReportsUri) return Aim::Reports;
  if (request.method == "GET" && path == kStatusUri) return Aim::Status;
  return std::nullopt;
}

std::optional<Aim> mapping_aim(const Request& request) {
  if (request.fault || !names_one_of(request, kMappingFunctions)) return std::nullopt;
  return Aim::Mapping;
}

/// Of a request that a fault keeps from its judge. It breaks no rule of the ICD, since nobody looked.
Judgement skip_judgement(Aim aim, const Request& request) {
  Judgement judgement;
  judgement.uri = aim == Aim::Mapping ? request.path : strip_slash(request.path);
  if (aim == Aim::Reports) {  // so that the transcript shows which report came to nothing
    if (auto document = read_document(request.body, Format::JsonText)) judgement.message = document->value;
  }
  return judgement;
}

/// Of a request that is answered before anything of it is judged.
Judgement early_judgement(const Request& request, std::optional<Aim> aim, Outcome outcome) {
  Judgement judgement = aim ? skip_judgement(*aim, request) : Judgement{};
  judgement.uri = request.path;
  judgement.outcome = std::move(outcome);
  return judgement;
}

/// `then` decides, after `delay`.
Outcome later(Fault::Seconds delay, std::function<Outcome()> then) {
  return {.kind = Outcome::Kind::Later,
          .delay = std::chrono::duration_cast<std::chrono::milliseconds>(delay),
          .then = std::move(then)};
}

/// A judge never falls, whatever it reads: memory that runs out is answered, too.
Judgement judge_safely(Endpoint& endpoint, const Request& request) {
  try {
    return endpoint.judge(request);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "adit-rehearsal: error while handling a request: %s\n", error.what());
    Judgement judgement;
    judgement.outcome = last_answer(answer_refusal(500, "The request could not be handled"));
    return judgement;
  }
}

/// The JSON of a body; std::nullopt if it is empty.
std::expected<std::optional<Json>, std::string> body_of(const Request& request) {
  if (request.body.empty()) return std::nullopt;
  auto document = read_document(request.body, Format::JsonText);
  if (!document) return std::unexpected("the body is not JSON: " + document.error());
  if (document->repeated) return std::unexpected("'" + *document->repeated + "' is given twice");
  return std::move(document->value);
}

Outcome change_state(Run& run, Run::Change wanted) {
  const auto now = Clock::now();
  const bool done = run.change(wanted, now);
  const std::string state = run.standing(now).state;
  if (!done) return answer_refusal(409, "the run is: " + state);
  return answer_with(200, OrderedJson{{"state", state}});
}

std::expected<NewRun, std::string> read_new_run(const Json& wanted) {
  if (!wanted.is_object()) return std::unexpected(R"(expected an object, as in {"run": "2"})");
  NewRun run;
  for (const auto& [name, value] : wanted.items()) {
    auto* const text = name == "run" ? &run.id : name == "team" ? &run.team : nullptr;
    if (text != nullptr) {
      if (!value.is_string() || value == "") return std::unexpected(name + ": expected a text");
      *text = value.get<std::string>();
    } else if (name != "started") {
      return std::unexpected("no such member: '" + name.substr(0, 80) + "'; there are run, team, started");
    } else if (!value.is_boolean()) {
      return std::unexpected("started: expected true or false");
    } else {
      run.started = value.get<bool>();
    }
  }
  return run;
}

Outcome begin_new_run(Run& run, const std::optional<Json>& sent) {
  const auto wanted = sent ? read_new_run(*sent) : NewRun{};
  if (!wanted) return answer_refusal(422, wanted.error());
  const auto now = Clock::now();
  run.restart(*wanted, now);
  const Run::Standing standing = run.standing(now);
  return answer_with(200,
                     OrderedJson{{"state", standing.state}, {"run", standing.run}, {"team", standing.team}});
}

bool is_report(const Json& sent) {
  Findings findings;
  const Field report(sent, "", findings);
  return read_point(report) && report.text("type");
}

CommandPost::CommandPost(const Options& options, const Secrets& secrets, std::vector<Artifact> artifacts,
                         std::unique_ptr<Transcript> transcript)
    : options_(options),
      run_(options.run, std::move(artifacts)),
      record_(options.manner),
      faults_(options.seed),
      scoring_{scoring_endpoint(options.manner, secrets.scoring, options.rate, options.one_api_limit, run_),
               "scoring"},
      mapping_{mapping_endpoint(options.manner, secrets.mapping, options.rate, options.counted), "mapping"},
      transcript_(std::move(transcript)),
      number_(transcript_ ? transcript_->requests() : 0) {
  if (!options.not_started) run_.change(Run::Change::Start, Clock::now());
}

Outcome CommandPost::scoring(const Request& request) {
  return receive(scoring_, scoring_aim(request, options_.manner), request);
}

Outcome CommandPost::mapping(const Request& request) {
  return receive(mapping_, mapping_aim(request), request);
}

/// Before anything of it is judged, as a framework does; no fault is spent on it.
bool CommandPost::redirects(const Request& request) const {
  return options_.slash && !request.fault && lacks_slash(request);
}

/// ICD 6.4 and 6.5: a name is one of the robots' that are registered. A state says each of them once.
void CommandPost::check_names(Judgement& judgement) const {
  std::set<std::string> posed;
  for (const AcceptedPart& part : judgement.accepted.parts) {
    const bool is_robot = part.kind != "marker" && part.kind != "report" && !part.robot.empty();
    if (is_robot && !options_.roster.empty() &&
        std::ranges::find(options_.roster, part.robot) == options_.roster.end()) {
      judgement.findings.add_remark("name: '" + part.robot + "' is not on the roster (ICD 2)");
    }
    if (part.kind == "pose" && !posed.insert(part.robot).second) {
      judgement.findings.add_remark("poses: '" + part.robot + "' is given twice");
    }
  }
}

/// ICD 5: about one request a second. A status may follow at once only if the report's answer was lost.
void CommandPost::note_order(const Request& request, const Fault& fault, Judgement& judgement) {
  const double hz = options_.rate.value_or(options_.manner == Manner::Strict ? 1 : 0);
  if (judgement.report) reported_.reset();
  if (judgement.report && words_of(fault) == kOk) reported_ = request.at;
  if (judgement.uri != kStatusUri || hz == 0 || !reported_) return;
  constexpr double kTolerance = 0.95;  // as RateLimit's
  if (request.at - *reported_ < std::chrono::duration<double>(kTolerance / hz))
    judgement.findings.add_remark("a status right behind a report that was answered (ICD 5)");
}

/// Before there was one: no answer.
Outcome CommandPost::last_answer_to(Aim aim) {
  const std::lock_guard lock(answers_mutex_);
  const auto& before = answers_[static_cast<std::size_t>(aim)];
  if (!before) return {.kind = Outcome::Kind::Breaks, .after = ConnectionAction::Close};
  return {.answer = *before, .after = ConnectionAction::Close};
}

void CommandPost::note_answer(Aim aim, const Outcome& outcome) {
  if (outcome.kind != Outcome::Kind::Answered || !icd::is_success(outcome.answer.status)) return;
  const std::lock_guard lock(answers_mutex_);
  answers_[static_cast<std::size_t>(aim)] = outcome.answer;
}

Outcome CommandPost::receive(Side& side, std::optional<Aim> aim, const Request& request) {
  if (redirects(request) || is_too_large(request)) return decide(side, aim, {}, request);
  const Fault fault = aim ? faults_.next(*aim, request.body, Clock::now()) : Fault{};
  if (!fault.record_after) return decide(side, aim, fault, request);
  return later(*fault.record_after, [this, &side, aim, fault, &request] {
    Request late = request;
    late.at = late.whole = Clock::now();  // it counts from when it is judged
    return decide(side, aim, fault, late);
  });
}

Judgement CommandPost::judge(Side& side, std::optional<Aim> aim, const Fault& fault, const Request& request) {
  if (request.fault) return judge_fault(*request.fault);
  if (redirects(request)) return early_judgement(request, aim, redirect(request));
  if (is_too_large(request))  // as nginx does by client_max_body_size
    return early_judgement(request, aim, last_answer(page(413, "Request Entity Too Large")));
  const bool judged = !aim || records(fault);
  Judgement judgement = judged ? judge_safely(*side.endpoint, request) : skip_judgement(*aim, request);
  check_names(judgement);
  arrivals_.note(judgement.accepted.markers, judgement.findings);
  if (!judged) judgement.outcome = last_answer_to(*aim);
  if (judged && aim) note_answer(*aim, judgement.outcome);
  note_order(request, fault, judgement);
  if (aim) spoil(fault, *aim, options_.manner, judgement);
  if (const std::string words = words_of(fault); words != kOk) judgement.fault = words;
  return judgement;
}

Outcome CommandPost::decide(Side& side, std::optional<Aim> aim, const Fault& fault, const Request& request) {
  if (fault.other_sender) report_from_another_sender(std::nullopt);
  std::unique_lock scoring_lock(scoring_mutex_, std::defer_lock);
  if (&side == &scoring_) scoring_lock.lock();
  Judgement judgement = judge(side, aim, fault, request);
  const std::uint64_t number = ++number_;
  if (transcript_) transcript_->request(number, side.name, request, judgement);
  record_.note(number, judgement);
  if (judgement.accepted.map)
    arrivals_.note(*judgement.accepted.map, std::chrono::floor<std::chrono::milliseconds>(request.ended));
  if (judgement.report) keep(std::move(*judgement.report), kByClient, number);
  if (scoring_lock) scoring_lock.unlock();
  if (options_.verbose) show(number, request, judgement);
  if (judgement.outcome.kind == Outcome::Kind::Dies) {
    std::fprintf(stderr, "adit-rehearsal: mapping killed by %s\n", record_.killed_by().c_str());
  }
  if (!fault.answer_after) return std::move(judgement.outcome);
  return later(*fault.answer_after, [outcome = std::move(judgement.outcome)] { return outcome; });
}

OrderedJson CommandPost::record() const {
  const std::lock_guard lock(scoring_mutex_);
  OrderedJson record = record_.json(run_.standing(Clock::now()));
  record.update(arrivals_.json());
  return record;
}

void CommandPost::keep(OrderedJson report, const char* by, const OrderedJson& request) {
  report["by"] = by;
  report["request"] = request;
  if (transcript_) transcript_->report(report);
  record_.note_report(report);
}

OrderedJson CommandPost::report_from_another_sender(const std::optional<Json>& sent) {
  constexpr double far = 100'000;  // metres: no artifact is there, and no two of its reports are alike
  const Json report =
      sent ? *sent : Json{{"x", far}, {"y", far + ++by_others_}, {"z", 0.0}, {"type", "Rope"}};
  const Vector3 position{report["x"].get<double>(), report["y"].get<double>(), report["z"].get<double>()};
  const std::lock_guard lock(scoring_mutex_);
  const Run::Ruling ruling = run_.submit(report["type"].get<std::string>(), position, Clock::now());
  OrderedJson body = report_body(ruling, report, kNoAuthority);
  keep(body, kByOther, nullptr);
  return body;
}

void CommandPost::show(std::uint64_t number, const Request& request, const Judgement& judgement) const {
  const Outcome& outcome = judgement.outcome;
  const bool answers = outcome.kind == Outcome::Kind::Answered;
  const std::string status = answers ? std::to_string(outcome.answer.status) : "no answer";
  const auto& parts = judgement.accepted.parts;
  const std::string first =
      parts.empty() ? "" : icd::sentence(" ", parts.front().kind, " ", parts.front().robot);
  // As JSON, so that nothing from the wire steers the terminal.
  const std::string what = line_of(Json(request.method + " " + request.target.substr(0, 200) + first));
  std::string more = judgement.fault.empty() ? "" : " [" + judgement.fault + "]";
  for (const std::string& sentence : judgement.findings.violations()) more += " " + line_of(Json(sentence));
  print(icd::sentence(aligned_right(std::to_string(number), 6), " ", what, ": ", status, more, "\n"));
}

Outcome CommandPost::show_arrivals() const {
  OrderedJson arrivals = arrivals_.json();
  arrivals["table"] = arrivals_.table();
  return answer_with(200, arrivals);
}

Outcome CommandPost::control(const Request& request) {
  if (request.fault) return last_answer(answer_refusal(request.fault->status, request.fault->sentence));
  const std::string wanted = request.method + " " + std::string(path_of(request.target));
  const auto body = body_of(request);
  if (!body) return answer_refusal(400, body.error());
  const std::optional<Json>& sent = *body;
  if (wanted == "GET /record") return answer_with(200, record());
  if (wanted == "GET /arrivals") return show_arrivals();
  if (wanted == "POST /posted") {
    const OrderResult told = arrivals_.set_expected(sent.value_or(Json()));
    return told ? show_arrivals() : answer_refusal(422, told.error());
  }
  if (wanted == "GET /faults") return answer_with(200, faults_.remaining());
  if (wanted == "POST /faults") {
    const OrderResult told = faults_.add_orders(sent.value_or(Json()));
    return told ? answer_with(200, faults_.remaining()) : answer_refusal(422, told.error());
  }
  if (wanted == "DELETE /faults") {
    faults_.clear();
    return answer_with(200, faults_.remaining());
  }
  if (wanted == "POST /other-sender") {
    if (!sent || is_report(*sent)) return answer_with(201, report_from_another_sender(sent));
    return answer_refusal(422, R"(expected a report, as in {"x": 1, "y": 2, "z": 3, "type": "Drill"})");
  }
  if (wanted == "POST /new-run") return begin_new_run(run_, sent);
  if (wanted == "POST /grant") return answer_with(200, OrderedJson{{"remaining_reports", run_.grant()}});
  if (wanted == "POST /rename") return answer_with(200, OrderedJson{{"run", run_.rename()}});
  if (wanted == "POST /start") return change_state(run_, Run::Change::Start);
  if (wanted == "POST /stop") return change_state(run_, Run::Change::Stop);
  if (wanted == "POST /resume") return change_state(run_, Run::Change::Resume);
  if (wanted == "POST /end") return change_state(run_, Run::Change::End);
  return answer_refusal(
      404,
      "POST /start, /stop, /resume, /end, /new-run, /grant, /rename, /other-sender or /posted, GET "
      "/record or /arrivals, GET, POST or DELETE /faults");
}

using command_line::number;
using command_line::Presence;
using command_line::set_by;
using command_line::Wrong;

constexpr double kMost = 1e9;

std::expected<Address, std::string> listening_address(const std::string& text) {
  auto address = read_address(text, 0);
  if (!address) return wrong("expected ADDR:PORT, got '", text, "': ", address.error());
  return address;
}

std::expected<RateBasis, std::string> parse_rate_basis(const std::string& text) {
  if (text == "starts") return RateBasis::Starts;
  if (text == "last-bytes") return RateBasis::LastBytes;
  if (text == "answers") return RateBasis::Answers;
  return std::unexpected("expected starts, last-bytes or answers, got '" + text + "'");
}

std::expected<std::vector<std::string>, std::string> roster_of(const std::string& text) {
  std::vector<std::string> roster;
  for (std::string_view rest = text; !rest.empty();) {
    const std::string& name = roster.emplace_back(icd::cut(rest, ','));
    if (is_robot_name(name)) continue;
    return std::unexpected("expected names of 1 to 10 letters, digits and underscores, got '" + name + "'");
  }
  return roster;
}

/// The ICD's section 5 can be read so that its rate is of all API requests together.
Wrong parse_rate(Options& options, const std::string& text) {
  options.one_api_limit = text == "api";
  if (options.one_api_limit) {
    options.rate = 1;
    return std::nullopt;
  }
  double rate = 0;
  auto fault = command_line::read_number(text, 0.0, kMost, rate);
  if (!fault) options.rate = rate;
  return fault;
}

Wrong parse_as_measured(Options& options, const std::string&) {
  options.manner = Manner::AsMeasured;
  options.run.renames = false;
  return std::nullopt;
}

[[gnu::cold]] command_line::Program command_line_of(Options& options) {
  return {
      .name = "adit-rehearsal",
      .usage = "",
      .about = "Simulated Command Post for rehearsals.",
      .rows =
          {{"--scoring", "ADDR:PORT", "address of the scoring endpoint (port 0: any free port)",
            parsed_value<listening_address>(options.scoring), Presence::Required},
           {"--mapping", "ADDR:PORT", "address of the mapping endpoint",
            parsed_value<listening_address>(options.mapping), Presence::Required},
           {"--secrets", "DIR", "directory of the tokens: scoring.token and mapping.token", &options.secrets,
            Presence::Required},
           {"--artifacts", "CSV", "true artifacts that reports are scored against: type,x,y,z",
            &options.artifacts},
           {"--transcript", "DIR", "record every request in this directory", &options.transcript},
           {"--transcript-mb", "N", "save no more map pictures when the transcript has N MB (2000)",
            number<0UL, UINT32_MAX>(options.transcript_megabytes)},
           {"--as-measured", "", "behave like the public test servers instead of the ICD",
            set_by<parse_as_measured>(options)},
           {"--slash", "", "redirect a path without a trailing slash to the path with one", &options.slash},
           {"--serial", "", "serve one connection of each endpoint at a time, until it is closed",
            &options.serial},
           {"--limit-bytes", "N", "answer a larger body with 413 and a page, as a proxy does (0: no limit)",
            number<0UL, UINT64_MAX>(options.limit_bytes)},
           {"--team", "NAME", "name of the team", &options.run.team},
           {"--run", "ID", "name of the run", &options.run.id},
           {"--duration", "SECONDS", "length of the run (3600)", number<0.0, kMost>(options.run.length)},
           {"--reports", "N", "number of artifact reports that the run allows (45)",
            number<0L, INT64_MAX>(options.run.reports)},
           {"--rate", "HZ|api",
            "answer 429 above this rate, for each URI (1; 0: no limit); api: 1 Hz, with one limit for "
            "statuses and reports together",
            set_by<parse_rate>(options)},
           {"--counts", "WHAT",
            "starts, last-bytes or answers: where --rate measures the interval between two maps, states or "
            "markers messages",
            parsed_value<parse_rate_basis>(options.counted)},
           {"--link", "MBIT",
            "limit the data received at both endpoints together to MBIT Mbit/s (0: no limit)",
            number<0.0, kMost>(options.link)},
           {"--roster", "NAME,...", "names of the registered robots; any other name is a violation",
            parsed_value<roster_of>(options.roster)},
           {"--not-started", "", "start the run only on POST /start at the control port",
            &options.not_started},
           {"--fault", "AIM:FAULT", "apply FAULT to the next request of AIM; may be given several times",
            &options.faults},
           {"--fault-rate", "AIM:FAULT=RATE",
            "apply FAULT at random to this share (0 to 1) of the requests of AIM; may be given several times",
            &options.fault_rates},
           {"--seed", "N", "seed of the random faults (1)", number<0UL, UINT64_MAX>(options.seed)},
           {"--control", "ADDR:PORT",
            "address of the control port: POST /start /stop /resume /end /new-run /grant /rename "
            "/other-sender /posted, GET /record /arrivals, GET, POST and DELETE /faults",
            parsed_value<listening_address>(options.control)},
           {"--verbose", "", "print a line for each request even if stdout is not a terminal",
            &options.verbose}},
      .ending =
          "If installed, adit-rehearsal demo starts this program, Adit and robots and prints the address of "
          "the page. See adit-rehearsal demo --help.\n"
          "AIM: reports, status or mapping. clock:constant stops the run's clocks in all later answers; "
          "clock:running starts them again.\n"
          "FAULT: ok, or one or more of these, separated by commas:\n"
          "  drop, reset-unrecorded, 401, 429[=COUNT], 500     not recorded\n"
          "  html-200, html-302, html-400, html-422            not recorded; a page of HTML\n"
          "  repeat-answer                                     not recorded; the previous answer again\n"
          "  record-then-drop, reset, half-answer, garbage, 500-recorded\n"
          "                                                    recorded; the answer is lost\n"
          "  length-huge, chunk-huge, header-flood, 1xx-flood, endless-body, json-deep\n"
          "                                                    recorded; an answer too long or too deep\n"
          "  record-after=SECONDS, answer-after=SECONDS        recorded or answered late\n"
          "  other-sender                                      another sender's report is recorded first\n"
          "  remaining=+N, remaining=-N                        remaining_reports is wrong by N from then on\n"
          "  retry-after=SECONDS                               the answer has this header\n"
          "  for=SECONDS                                       all requests of AIM for this long\n"
          "  robot=NAME                                        only messages that contain this name",
  };
}

constexpr int kWrongUse = 2;
constexpr std::size_t kMostSmallBody = std::size_t{1} << 20;  // of scoring and control
constexpr int kKilled = 3;  // the mapping server as measured died of a message

int complain(const std::string& why) {
  std::fprintf(stderr, "adit-rehearsal: %s\n", why.c_str());
  return kWrongUse;
}

OrderResult add_faults(const Options& options, Faults& faults) {
  for (const std::string& text : options.faults) {
    if (auto told = faults.add_order(text); !told) return std::unexpected("--fault: " + told.error());
  }
  for (const std::string& text : options.fault_rates) {
    if (auto told = faults.add_rate(text); !told) return std::unexpected("--fault-rate: " + told.error());
  }
  return {};
}

/// Also names a wrong fault if help is wanted, so that --help checks a command line.
std::expected<Options, std::string> parse_options(std::span<const char* const> arguments) {
  Options options = ADIT_TRY(command_line::read(command_line_of, arguments));
  Faults faults(options.seed);
  ADIT_TRY(add_faults(options, faults));
  return options;
}

std::expected<std::unique_ptr<CommandPost>, std::string> build(const Options& options) {
  const std::filesystem::path folder = options.secrets;
  const std::string scoring = ADIT_TRY(read_token(folder / "scoring.token"));
  const std::string mapping = ADIT_TRY(read_token(folder / "mapping.token"));
  std::vector<Artifact> artifacts;
  if (!options.artifacts.empty()) artifacts = ADIT_TRY(read_artifacts(options.artifacts));
  std::unique_ptr<Transcript> transcript;
  if (!options.transcript.empty())
    transcript = ADIT_TRY(Transcript::open(options.transcript, options.transcript_megabytes * 1'000'000));
  auto post = std::make_unique<CommandPost>(options, Secrets{scoring, mapping}, std::move(artifacts),
                                            std::move(transcript));
  ADIT_TRY(add_faults(options, post->faults()));
  return post;
}

using Servers = std::vector<std::pair<const char*, std::unique_ptr<Server>>>;  // with their names

std::expected<Servers, std::string> listen(const Options& options, CommandPost& post) {
  Servers servers;
  const auto add = [&](const char* name, const Address& address, const WireManner& manner,
                       Decide decide) -> OrderResult {
    auto server = Server::listen(address, manner, std::move(decide));
    if (!server) return wrong(name, ": ", server.error());
    servers.emplace_back(name, *std::move(server));
    return {};
  };
  const WireManner mapping{.answers_expect = options.manner == Manner::Strict,
                           .slash = options.slash,
                           .serial = options.serial,
                           .link = options.link > 0 ? std::make_shared<Link>(options.link) : nullptr};
  WireManner scoring = mapping;
  scoring.answers_expect = true;
  scoring.most_body = kMostSmallBody;
  ADIT_TRY(add("scoring", options.scoring, scoring, std::bind_front(&CommandPost::scoring, &post)));
  ADIT_TRY(add("mapping", options.mapping, mapping, std::bind_front(&CommandPost::mapping, &post)));
  if (options.control) {
    ADIT_TRY(add("control", *options.control, {.most_body = kMostSmallBody},
                 std::bind_front(&CommandPost::control, &post)));
  }
  return servers;
}

std::string first_line(const Servers& servers) {
  std::string line = "adit-rehearsal:";
  for (const auto& [name, server] : servers)
    line.append(" ").append(name).append(" ").append(server->address().text());
  return line + "\n";
}

/// A client that is sending a large map has this long; then the process ends.
bool stop_all(const Servers& servers) {
  constexpr std::chrono::milliseconds patience{250};
  for (const auto& [name, server] : servers) server->stop();
  bool drained = true;
  for (const auto& [name, server] : servers) drained = server->wait_until_drained(patience) && drained;
  return drained;
}

int run(const Options& options) {
  const sigset_t signals = block_signals({SIGINT, SIGTERM, SIGUSR1});
  auto post = build(options);
  if (!post) return complain(post.error());
  const auto servers = listen(options, **post);
  if (!servers) return complain(servers.error());
  print(first_line(*servers));
  for (int signal = SIGUSR1; signal == SIGUSR1;) {
    if (sigwait(&signals, &signal) != 0) break;
    if (signal == SIGUSR1) print((*post)->summary());
  }
  const bool drained = stop_all(*servers);
  print((*post)->summary());
  const int code = (*post)->killed_by().empty() ? EXIT_SUCCESS : kKilled;
  if (!drained) std::_Exit(code);  // a thread still works on what they share
  return code;
}

/// The script that is installed beside this program, in its place, with the programs in this one's folder:
/// arguments[0] is "demo".
int demo(char** arguments) {
  std::error_code error;
  const auto folder = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  const std::string script = folder.parent_path() / "lib/adit-rehearsal/demo";
  if (::setenv("ADIT_BIN", folder.c_str(), 1) == 0) ::execv(script.c_str(), arguments);
  return complain(script + ": " + std::strerror(errno));
}

}  // namespace
}  // namespace adit::rehearsal

int main(int count, char** arguments) {
  using namespace adit::rehearsal;
  if (count > 1 && std::string_view(arguments[1]) == "demo") return demo(arguments + 1);
  auto options = parse_options({arguments + 1, arguments + count});
  if (const auto exit = adit::command_line::answer(command_line_of, ADIT_VERSION, options)) return *exit;
  options->verbose = options->verbose || ::isatty(STDOUT_FILENO) == 1;
  return run(*options);
}
