#include "rehearsal/command_post/command_post.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <set>

#include "icd/sentence.hpp"
#include "icd/status.hpp"
#include "rehearsal/common.hpp"

namespace adit::rehearsal {
namespace {

/// After it the connection ends.
Outcome last_answer(Outcome outcome) {
  outcome.after = After::Close;
  return outcome;
}

/// What is no HTTP request is refused alike by all. One that its sender broke off, or that came too slowly,
/// is written down, but breaks no rule of the ICD.
Judgement judge_fault(const HttpFault& fault) {
  constexpr int timeout = 408;
  Judgement judgement;
  if (fault.status != 0 && fault.status != timeout) {
    judgement.findings.breaks(fault.sentence, Measured::Refuses, fault.status);
  }
  judgement.outcome = last_answer(refused(fault.status, fault.sentence));
  return judgement;
}

/// The aim of a request to either endpoint, if it has one. As measured, slashes may end the path.
std::optional<Aim> scoring_aim(const Request& request, Manner manner) {
  std::string_view path = request.path;
  if (manner == Manner::AsMeasured) path = without_slash(path);
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
Judgement unjudged(Aim aim, const Request& request) {
  Judgement judgement;
  judgement.uri = aim == Aim::Mapping ? request.path : without_slash(request.path);
  if (aim == Aim::Reports) {  // so that the transcript shows which report came to nothing
    if (auto document = read_document(request.body, Format::JsonText)) judgement.message = document->value;
  }
  return judgement;
}

/// Of a request that is answered before anything of it is judged.
Judgement turned_away(const Request& request, std::optional<Aim> aim, Outcome outcome) {
  Judgement judgement = aim ? unjudged(*aim, request) : Judgement{};
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
    judgement.outcome = last_answer(refused(500, "The request could not be handled"));
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
  if (!done) return refused(409, "the run is: " + state);
  return answered(200, OrderedJson{{"state", state}});
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
  if (!wanted) return refused(422, wanted.error());
  const auto now = Clock::now();
  run.begin_again(*wanted, now);
  const Run::Standing standing = run.standing(now);
  return answered(200,
                  OrderedJson{{"state", standing.state}, {"run", standing.run}, {"team", standing.team}});
}

bool is_report(const Json& sent) {
  Findings findings;
  const Field report(sent, "", findings);
  return read_point(report) && report.text("type");
}

}  // namespace

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
void CommandPost::note_names(Judgement& judgement) const {
  std::set<std::string> posed;
  for (const Accepted& part : judgement.accepted.parts) {
    const bool is_robot = part.kind != "marker" && part.kind != "report" && !part.robot.empty();
    if (is_robot && !options_.roster.empty() &&
        std::ranges::find(options_.roster, part.robot) == options_.roster.end()) {
      judgement.findings.tells("name: '" + part.robot + "' is not on the roster (ICD 2)");
    }
    if (part.kind == "pose" && !posed.insert(part.robot).second) {
      judgement.findings.tells("poses: '" + part.robot + "' is given twice");
    }
  }
}

/// ICD 5: approximately one request a second. A status may follow at once only if the report's answer was
/// lost.
void CommandPost::note_order(const Request& request, const Fault& fault, Judgement& judgement) {
  const double hz = options_.rate.value_or(options_.manner == Manner::Strict ? 1 : 0);
  if (judgement.report) reported_.reset();
  if (judgement.report && words_of(fault) == kOk) reported_ = request.at;
  if (judgement.uri != kStatusUri || hz == 0 || !reported_) return;
  constexpr double kTolerance = 0.95;  // as RateLimit's
  if (request.at - *reported_ < std::chrono::duration<double>(kTolerance / hz))
    judgement.findings.tells("a status right behind a report that was answered (ICD 5)");
}

/// Before there was one: no answer.
Outcome CommandPost::last_answer_to(Aim aim) {
  const std::lock_guard lock(answers_mutex_);
  const auto& before = answers_[static_cast<std::size_t>(aim)];
  if (!before) return {.kind = Outcome::Kind::Breaks, .after = After::Close};
  return {.answer = *before, .after = After::Close};
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
  if (redirects(request)) return turned_away(request, aim, redirected(request));
  if (is_too_large(request))  // as nginx does by client_max_body_size
    return turned_away(request, aim, last_answer(page(413, "Request Entity Too Large")));
  const bool judged = !aim || records(fault);
  Judgement judgement = judged ? judge_safely(*side.endpoint, request) : unjudged(*aim, request);
  note_names(judgement);
  arrivals_.note(judgement.accepted.markers, judgement.findings);
  if (!judged) judgement.outcome = last_answer_to(*aim);
  if (judged && aim) note_answer(*aim, judgement.outcome);
  note_order(request, fault, judgement);
  if (aim) spoil(fault, *aim, options_.manner, judgement);
  if (const std::string words = words_of(fault); words != kOk) judgement.fault = words;
  return judgement;
}

Outcome CommandPost::decide(Side& side, std::optional<Aim> aim, const Fault& fault, const Request& request) {
  if (fault.other_sender) other_sender(std::nullopt);
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

OrderedJson CommandPost::other_sender(const std::optional<Json>& sent) {
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
  return answered(200, arrivals);
}

Outcome CommandPost::control(const Request& request) {
  if (request.fault) return last_answer(refused(request.fault->status, request.fault->sentence));
  const std::string wanted = request.method + " " + std::string(path_of(request.target));
  const auto body = body_of(request);
  if (!body) return refused(400, body.error());
  const std::optional<Json>& sent = *body;
  if (wanted == "GET /record") return answered(200, record());
  if (wanted == "GET /arrivals") return show_arrivals();
  if (wanted == "POST /posted") {
    const Told told = arrivals_.told(sent.value_or(Json()));
    return told ? show_arrivals() : refused(422, told.error());
  }
  if (wanted == "GET /faults") return answered(200, faults_.left());
  if (wanted == "POST /faults") {
    const Told told = faults_.tell_all(sent.value_or(Json()));
    return told ? answered(200, faults_.left()) : refused(422, told.error());
  }
  if (wanted == "DELETE /faults") {
    faults_.clear();
    return answered(200, faults_.left());
  }
  if (wanted == "POST /other-sender") {
    if (!sent || is_report(*sent)) return answered(201, other_sender(sent));
    return refused(422, R"(expected a report, as in {"x": 1, "y": 2, "z": 3, "type": "Drill"})");
  }
  if (wanted == "POST /new-run") return begin_new_run(run_, sent);
  if (wanted == "POST /grant") return answered(200, OrderedJson{{"remaining_reports", run_.grant()}});
  if (wanted == "POST /rename") return answered(200, OrderedJson{{"run", run_.rename()}});
  if (wanted == "POST /start") return change_state(run_, Run::Change::Start);
  if (wanted == "POST /stop") return change_state(run_, Run::Change::Stop);
  if (wanted == "POST /resume") return change_state(run_, Run::Change::Resume);
  if (wanted == "POST /end") return change_state(run_, Run::Change::End);
  return refused(
      404,
      "POST /start, /stop, /resume, /end, /new-run, /grant, /rename, /other-sender or /posted, GET "
      "/record or /arrivals, GET, POST or DELETE /faults");
}

}  // namespace adit::rehearsal
