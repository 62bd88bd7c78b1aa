#include "simulation/command_post.hpp"

#include <cerrno>
#include <cstdio>
#include <utility>

#include "simulation/messages.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr int kSeenToRun = 4;  // statuses that were answered
constexpr double kLatest = 8;  // seconds after which nothing is recorded any more
constexpr const char* kJson = "Content-Type: application/json\r\n";
constexpr const char* kHtml = "<html><body>Please log in</body></html>";

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  return text;
}

}  // namespace

/// One connection. The requests that it reads are answered one after the other.
class CommandPost::Conversation final : public Peer {
 public:
  Conversation(CommandPost& post, Link& link) : post_(post), link_(link) {}
  void came(std::string_view bytes) override {
    stream_.feed(bytes);
    while (const auto request = stream_.next()) post_.asked(*request, link_);
  }
  void ended() override {}

 private:
  CommandPost& post_;
  Link& link_;  // whose this is
  HttpStream stream_;
};

CommandPost::CommandPost(World& world, double trouble_for)
    : world_(world),
      faults_(world.random("faults")),
      random_(world.random("command post")),
      run_began_(-random_.between(300, 3000)) {
  for (const Fault fault : {Fault::Storm, Fault::PoliteStorm, Fault::Refused, Fault::Deaf, Fault::NewRun}) {
    // Nobody can tell one run from the next by clocks that stand.
    const bool untold = fault == Fault::NewRun && faults_.has(Fault::ConstantClocks);
    if (faults_.has(fault) && !untold) plan_periods(fault, trouble_for);
  }
}

void CommandPost::note(Fault fault, const std::string& path) {
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = path, .who = name_of(fault)});
}

void CommandPost::plan_periods(Fault fault, double trouble_for) {
  for (std::uint64_t i = 1 + random_.below(2); i > 0; --i) {
    const double begins = random_.between(1, trouble_for), takes = random_.between(0.5, 8);
    if (world_.omits(name_of(fault))) continue;
    if (fault == Fault::NewRun) return world_.after(seconds(begins), [this] { begin_run(); });
    bool& is = fault == Fault::Storm         ? storm_
               : fault == Fault::PoliteStorm ? polite_
               : fault == Fault::Refused     ? refused_
                                             : deaf_;
    world_.after(seconds(begins), [this, fault, &is] {
      if (calm_) return;
      is = true;
      note(fault, "begins");
    });
    world_.after(seconds(begins + takes), [&is] { is = false; });
  }
}

/// Not before its clock was seen to run: nothing would tell the one from the other.
void CommandPost::begin_run() {
  if (calm_) return;
  if (statuses_ < kSeenToRun) return world_.after(seconds(5), [this] { begin_run(); });
  ++run_;
  remaining_ = 25;
  score_ = 0;
  run_began_ = world_.time();
  world_.note({.actor = Actor::Post, .kind = Kind::NewRun, .what = "", .who = "", .serial = run_});
}

void CommandPost::calm() {
  calm_ = true;
  storm_ = polite_ = refused_ = deaf_ = false;
  world_.note({.actor = Actor::Post, .kind = Kind::Calm, .what = "", .who = ""});
}

std::optional<int> CommandPost::connecting(const uplink::Endpoint&) {
  if (deaf_) return std::nullopt;
  return refused_ ? ECONNREFUSED : 0;
}

std::unique_ptr<Peer> CommandPost::connected(const uplink::Endpoint&, Link& link) {
  return std::make_unique<Conversation>(*this, link);
}

void CommandPost::asked(const HttpMessage& request, Link& link) {
  if (storm_ || polite_) {
    const std::string after =
        polite_ ? "Retry-After: " + std::to_string(1 + random_.below(4)) + "\r\n" : std::string();
    return link.send(http_answer("429 Too Many Requests", kJson + after, "\"too many requests\""));
  }
  const Fault fault = calm_ ? Fault::End : faults_.of_request();
  if (fault != Fault::End && !world_.omits(name_of(fault))) return misbehave(fault, request, link);
  if (request.path() == kStatus) ++statuses_;
  link.send(take(request), seconds(random_.between(0, 0.01)));
}

void CommandPost::take_later(const HttpMessage& request, double within) {
  world_.after(seconds(random_.between(0, within)), [this, request] { take(request); });
}

void CommandPost::misbehave(Fault fault, const HttpMessage& request, Link& link) {
  note(fault, request.path());
  const auto soon = seconds(random_.between(0, 0.5));
  switch (fault) {
    case Fault::LostBefore:
      return link.end(Link::How::Reset, soon);
    case Fault::LostAfter:
      request.path() == kReports&& random_.chance(0.5) ? take_later(request, kLatest) : void(take(request));
      return link.end(Link::How::Reset, soon);
    case Fault::CutAnswer: {
      const std::string answer = take(request);
      link.send(answer.substr(0, random_.below(answer.size())), soon);
      return link.end(random_.chance(0.5) ? Link::How::End : Link::How::Reset, soon);
    }
    case Fault::Delay: {
      const auto late = seconds(random_.between(0.1, kLatest));
      if (request.path() != kReports) return link.send(take(request), late);
      world_.after(late, [this, request, self = link.shared_from_this()] { self->send(take(request)); });
      return;
    }
    case Fault::Silence:
      if (random_.chance(0.5)) take(request);
      return;
    case Fault::Error:
      if (random_.chance(0.5)) take(request);
      return link.send(random_.chance(0.5)
                           ? http_answer("500 Internal Server Error", kJson, "\"failed\"")
                           : http_answer("500 Internal Server Error", "Content-Type: text/html\r\n", kHtml),
                       soon);
    case Fault::Html:
      return link.send(http_answer("200 OK", "Content-Type: text/html\r\n", kHtml), soon);
    case Fault::HugeLength:
      if (random_.chance(0.5)) take(request);
      return link.send(
          "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: 1000000000000\r\n\r\n{",
          soon);
    default:
      return;
  }
}

std::string CommandPost::take(const HttpMessage& request) {
  const std::string path = request.path();
  if (path == kStatus) return status();
  const auto items = items_of(request);
  if (items.empty()) return http_answer("422 Unprocessable Entity", kJson, "\"what is this?\"");
  if (path == kReports) return record(items.front());
  for (const Item& item : items) {
    world_.note({.actor = Actor::Post,
                 .kind = Kind::Taken,
                 .what = path,
                 .who = item.who,
                 .serial = item.serial,
                 .stamp = item.stamp,
                 .says = item.says});
  }
  return http_answer("200 OK", kJson, "null");
}

std::string CommandPost::status() const {
  const double clock = faults_.has(Fault::ConstantClocks) ? 25.98 : world_.time() - run_began_;
  return http_answer("200 OK", kJson,
                     "{\"score\": " + std::to_string(score_) + ", \"run_clock\": " + number(clock) +
                         ", \"remaining_reports\": " + std::to_string(remaining_) +
                         ", \"current_team\": \"adit\"}");
}

std::string CommandPost::record(const Item& item) {
  const bool scored = remaining_ > 0;
  const int points = scored && item.serial % 3 == 1 ? 1 : 0;
  if (scored) --remaining_;
  score_ += points;
  world_.note({.actor = Actor::Post,
               .kind = Kind::Taken,
               .what = kReports,
               .who = "run " + std::to_string(run_),
               .serial = item.serial,
               .stamp = static_cast<double>(points)});
  const bool stands = faults_.has(Fault::ConstantClocks);
  const double clock = stands ? 3.14 : world_.time() - run_began_;
  return http_answer("201 Created", kJson,
                     "{\"url\": \"\", \"id\": " + std::to_string(++id_) +
                         ", \"x\": " + number(static_cast<double>(item.serial) * 100) + ", \"run\": \"" +
                         std::to_string(stands ? 1 : run_) +
                         "\", \"team\": \"adit\", \"run_clock\": " + number(clock) +
                         ", \"report_status\": \"" + (scored ? "scored" : "report limit exceeded") +
                         "\", \"score_change\": " + std::to_string(points) + "}");
}

}  // namespace adit::simulation
