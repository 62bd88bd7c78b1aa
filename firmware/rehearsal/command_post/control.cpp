#include "rehearsal/command_post/control.hpp"

#include <map>
#include <string_view>

#include "rehearsal/command_post/gate.hpp"

namespace adit::rehearsal {

Outcome control(CommandPost& post, const Request& request) {
  using Deed = bool (Run::*)(Clock::time_point);
  static const std::map<std::string_view, Deed> deeds = {
      {"/start", &Run::start}, {"/stop", &Run::admin_stop}, {"/resume", &Run::resume}, {"/end", &Run::end}};
  if (request.fault) {
    Outcome outcome = refused(request.fault->status, request.fault->sentence);
    outcome.after = After::Close;
    return outcome;
  }
  const std::string_view path = path_of(request.target);
  if (request.method == "GET" && path == "/record") return answered(200, post.record());
  const auto deed = deeds.find(path);
  if (request.method != "POST" || deed == deeds.end()) {
    return refused(404, "POST /start, /stop, /resume, /end or GET /record");
  }
  const auto now = Clock::now();
  const bool done = (post.run().*deed->second)(now);
  const std::string state = post.run().standing(now).state;
  if (!done) return refused(409, "the run is: " + state);
  return answered(200, OrderedJson{{"state", state}});
}

}  // namespace adit::rehearsal
