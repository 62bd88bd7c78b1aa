#include "rehearsal/command_post/control.hpp"

#include <expected>
#include <optional>
#include <string>

#include "rehearsal/command_post/gate.hpp"
#include "rehearsal/command_post/json.hpp"

namespace adit::rehearsal {
namespace {

/// What a body says; nothing where it is empty.
std::expected<std::optional<Json>, std::string> body_of(const Request& request) {
  if (request.body.empty()) return std::nullopt;
  auto document = read_document(request.body, Format::JsonText);
  if (!document) return std::unexpected("the body is not JSON: " + document.error());
  if (document->repeated) return std::unexpected("'" + *document->repeated + "' is given twice");
  return std::move(document->value);
}

Outcome change_state(CommandPost& post, bool (Run::*wanted)(Clock::time_point)) {
  const auto now = Clock::now();
  const bool done = (post.run().*wanted)(now);
  const std::string state = post.run().standing(now).state;
  if (!done) return refused(409, "the run is: " + state);
  return answered(200, OrderedJson{{"state", state}});
}

std::expected<NewRun, std::string> read_new_run(const Json& wanted) {
  if (!wanted.is_object()) return std::unexpected(R"(expected an object, as in {"run": "2"})");
  NewRun run;
  for (const auto& [name, value] : wanted.items()) {
    const bool text = value.is_string() && !value.get_ref<const std::string&>().empty();
    if ((name == "run" || name == "team") && !text) return std::unexpected(name + ": expected a text");
    if (name == "run") {
      run.id = value.get<std::string>();
    } else if (name == "team") {
      run.team = value.get<std::string>();
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

Outcome begin_new_run(CommandPost& post, const std::optional<Json>& wanted) {
  const auto run = wanted ? read_new_run(*wanted) : NewRun{};
  if (!run) return refused(422, run.error());
  const auto now = Clock::now();
  post.run().begin_again(*run, now);
  const Run::Standing standing = post.run().standing(now);
  return answered(200,
                  OrderedJson{{"state", standing.state}, {"run", standing.run}, {"team", standing.team}});
}

bool is_report(const Json& sent) {
  const auto has = [&sent](const char* name, auto kind) {
    const auto found = sent.find(name);
    return found != sent.end() && ((*found).*kind)();
  };
  return sent.is_object() && has("x", &Json::is_number) && has("y", &Json::is_number) &&
         has("z", &Json::is_number) && has("type", &Json::is_string);
}

Outcome submit_by_other(CommandPost& post, const std::optional<Json>& sent) {
  if (sent && !is_report(*sent)) {
    return refused(422, R"(expected a report, as in {"x": 1, "y": 2, "z": 3, "type": "Drill"})");
  }
  return answered(201, post.other_sender(sent));
}

Outcome tell_faults(CommandPost& post, const std::optional<Json>& told) {
  if (const auto taken = post.faults().tell_all(told.value_or(Json())); !taken) {
    return refused(422, taken.error());
  }
  return answered(200, post.faults().left());
}

Outcome arrivals(const CommandPost& post) {
  return answered(200, OrderedJson{{"maps", post.arrivals().json()},
                                   {"markers", post.display().json()},
                                   {"table", post.compared()}});
}

Outcome tell_posted(CommandPost& post, const std::optional<Json>& posted) {
  const Json all = posted.value_or(Json());
  if (const auto told = post.arrivals().told(all); !told) return refused(422, told.error());
  if (const auto told = post.display().told(all); !told) return refused(422, told.error());
  return arrivals(post);
}

Outcome clear_faults(CommandPost& post) {
  post.faults().clear();
  return answered(200, post.faults().left());
}

}  // namespace

Outcome control(CommandPost& post, const Request& request) {
  if (request.fault) {
    Outcome outcome = refused(request.fault->status, request.fault->sentence);
    outcome.after = After::Close;
    return outcome;
  }
  const std::string wanted = request.method + " " + std::string(path_of(request.target));
  const auto body = body_of(request);
  if (!body) return refused(400, body.error());
  if (wanted == "GET /record") return answered(200, post.record());
  if (wanted == "GET /arrivals") return arrivals(post);
  if (wanted == "POST /posted") return tell_posted(post, *body);
  if (wanted == "GET /faults") return answered(200, post.faults().left());
  if (wanted == "POST /faults") return tell_faults(post, *body);
  if (wanted == "DELETE /faults") return clear_faults(post);
  if (wanted == "POST /new-run") return begin_new_run(post, *body);
  if (wanted == "POST /grant")
    return answered(200, OrderedJson{{"remaining_reports", post.run().grant(Clock::now())}});
  if (wanted == "POST /rename") return answered(200, OrderedJson{{"run", post.run().rename()}});
  if (wanted == "POST /other-sender") return submit_by_other(post, *body);
  if (wanted == "POST /start") return change_state(post, &Run::start);
  if (wanted == "POST /stop") return change_state(post, &Run::admin_stop);
  if (wanted == "POST /resume") return change_state(post, &Run::resume);
  if (wanted == "POST /end") return change_state(post, &Run::end);
  return refused(
      404,
      "POST /start, /stop, /resume, /end, /new-run, /grant, /rename, /other-sender or /posted, GET "
      "/record or /arrivals, GET, POST or DELETE /faults");
}

}  // namespace adit::rehearsal
