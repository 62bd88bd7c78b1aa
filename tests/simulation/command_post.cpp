#include "simulation/command_post.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <span>
#include <utility>

#include "simulation/messages.hpp"
#include "simulation/odd_answers.hpp"
#include "simulation/team.hpp"
#include "simulation/world.hpp"

namespace adit::simulation {
namespace {

constexpr double kLatest = 8;  // seconds after which a lost request is not recorded any more
constexpr double kLongest = 8, kLongestOutage = 25;
constexpr std::chrono::milliseconds kOneLimit{950};  // "approximately" one request a second
constexpr const char *kEarly = "Early", *kPortal = "Portal";
constexpr const char* kPage = "Content-Type: text/html\r\n";
constexpr const char* kHtml = "<html><body>Please log in</body></html>";
constexpr Fault kPeriods[] = {Fault::Storm,       Fault::PoliteStorm, Fault::Refused, Fault::Deaf,
                              Fault::Mute,        Fault::Outage,      Fault::NewRun,  Fault::StatusDown,
                              Fault::OtherSender, Fault::AdminStop};

std::string numbered(const char* name, int place) {
  return place == 0 ? name : std::string(name) + " " + std::to_string(place);
}

bool is_mapping(const HttpMessage& request) {
  return request.path() != kReports && request.path() != kStatus;
}

}  // namespace

/// One connection. It answers its requests one after the other.
class CommandPost::Conversation {
 public:
  Conversation(CommandPost& post, Link& link) : post_(post), link_(link.shared_from_this()) {}
  void read(std::string_view bytes, const WhenLeft& left) {
    if (stream_.is_between()) began_ = left.first;
    stream_.feed(bytes);
    while (const auto request = stream_.next())
      post_.asked(*request, {.first = began_, .last = left.last}, *link_);
    if (!stream_.head() || post_.cuts_large(stream_, *link_)) return;
    post_.may_answer_early(*stream_.head(), *link_);
  }
  /// Keeps the bytes in the kernel, which has acknowledged them.
  void hold(std::string_view bytes, Instant left) {
    if (unread_.empty()) unread_left_.first = left;
    unread_left_.last = left;
    unread_ += bytes;
  }
  void read_unread() {
    if (!unread_.empty()) read(std::exchange(unread_, {}), unread_left_);
  }
  void end() { has_ended_ = true; }
  bool has_ended() const { return has_ended_ || link_->has_vanished(); }

 private:
  CommandPost& post_;
  const std::shared_ptr<Link> link_;
  HttpStream stream_;
  Instant began_{};  // time at which the first byte of the current request left
  std::string unread_;
  WhenLeft unread_left_{};
  bool has_ended_ = false;
};

class CommandPost::Reader final : public Peer {
 public:
  Reader(CommandPost& post, Link& link) : conversation_(post, link) {}
  void received(std::string_view bytes, Instant left) override {
    conversation_.read(bytes, {.first = left, .last = left});
  }
  void ended() override {}

 private:
  Conversation conversation_;
};

/// A server reads the next connection when the one before has ended, as a single thread does. Bytes of a
/// connection that has ended unread are read, too.
class CommandPost::SerialReader final : public Peer {
 public:
  SerialReader(CommandPost& post, Link& link, Accepted& accepted)
      : accepted_(accepted), conversation_(std::make_shared<Conversation>(post, link)) {
    accepted_.push_back(conversation_);
  }
  void received(std::string_view bytes, Instant left) override {
    conversation_->hold(bytes, left);
    serve();
  }
  void ended() override {
    conversation_->end();
    serve();
  }

 private:
  void serve() {
    while (!accepted_.empty()) {
      accepted_.front()->read_unread();
      if (!accepted_.front()->has_ended()) return;
      accepted_.pop_front();
    }
  }

  Accepted& accepted_;
  const std::shared_ptr<Conversation> conversation_;
};

CommandPost::CommandPost(World& world, const Faults& faults, double trouble_for, int place)
    : world_(world),
      faults_(faults),
      random_(world.random(numbered("command post", place))),
      early_(world.random(numbered("early answers", place))),
      repeating_(world.random(numbered("repeated answers", place))),
      pausing_(world.random(numbered("pauses", place))),
      failing_(world.random(numbered("failing maps", place))),
      gzips_(world.random(numbered("gzipped answers", place)).chance(0.15)),
      answers_early_(early_.chance(0.125) ? early_.uniform(0.05, 0.3) : 0),
      repeats_(repeating_.chance(0.125) ? repeating_.uniform(0.1, 0.4) : 0),
      fails_maps_(failing_.chance(0.125) ? failing_.uniform(0.3, 0.8) : 0),
      has_one_limit_(world.random(numbered("one limit", place)).chance(0.125)),
      is_serial_(world.random(numbered("serial", place)).chance(0.2)),
      scoreboard_(world, faults_, random_, place),
      counting_(world.random("counting")) {
  Random slash = world.random(numbered("slash", place));
  slash_ = slash.chance(0.15) ? Slash::Wanted : slash.chance(0.5) ? Slash::Unknown : Slash::Either;
  if (slash_ == Slash::Either && slash.chance(0.3)) redirects_reports_ = slash.chance(0.5) ? 307 : 308;
  Random proxy = world.random("proxy");
  if (proxy.chance(0.25)) largest_ = 400 + proxy.uniform_index(2000);
  is_below_single_ = proxy.chance(0.3);
  resets_large_ = proxy.chance(0.2);
  if (world.has_large_maps()) {
    resets_large_ = !world.has_large_grids() && proxy.chance(0.5);
    largest_ = resets_large_             ? 256'000 + proxy.uniform_index(100'000)
               : world.has_large_grids() ? 66'000 + proxy.uniform_index(24'000)
                                         : 70'000 + proxy.uniform_index(200'000);
  }
  plan_portal(trouble_for);
  plan_registry(trouble_for);
  for (const Fault fault : kPeriods) {
    // Runs cannot be told apart if their clocks stand still.
    const bool untold = fault == Fault::NewRun && faults_.has(Fault::ConstantClocks);
    if (faults_.has(fault) && !untold) plan_periods(fault, trouble_for);
  }
  if (!faults_.has(Fault::ConstantClocks)) plan_clerk(trouble_for);
}

/// In one of five runs the clock is set back, or one more report is granted, up to three times.
void CommandPost::plan_clerk(double trouble_for) {
  Random random = world_.random(numbered("clerk", scoreboard_.place()));
  if (!random.chance(0.2)) return;
  for (std::uint64_t i = 1 + random.uniform_index(3); i > 0; --i) {
    const bool grants = random.chance(0.4);
    const double when = random.uniform(1, trouble_for);
    if (world_.omits("clerk")) continue;
    world_.after(seconds(when), [this, grants] { let_clerk(grants); });
  }
}

/// In one of six runs, once or twice.
void CommandPost::plan_portal(double trouble_for) {
  Random random = world_.random(numbered("portal", scoreboard_.place()));
  if (!random.chance(0.17)) return;
  for (std::uint64_t i = 1 + random.uniform_index(2); i > 0; --i) {
    const double begins = random.uniform(0, trouble_for), takes = random.uniform(1, 15);
    if (world_.omits(kPortal)) continue;
    world_.after(seconds(begins), [this, takes] {
      if (calm_) return;
      world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = "begins", .who = kPortal});
      has_portal_ = true;
      world_.after(seconds(takes), [this] { has_portal_ = false; });
    });
  }
}

/// In one of five runs, for a time.
void CommandPost::plan_registry(double trouble_for) {
  constexpr const char* kLines[] = {"401 Unauthorized",
                                    "403 Forbidden",
                                    "404 Not Found",
                                    "409 Conflict",
                                    "415 Unsupported Media Type",
                                    "500 Internal Server Error",
                                    "501 Not Implemented",
                                    "503 Service Unavailable"};
  Random random = world_.random(numbered("registry", scoreboard_.place()));
  if (!random.chance(0.2)) return;
  const std::string robot = "R" + std::to_string(1 + random.uniform_index(3));
  const char* const line = kLines[random.uniform_index(std::size(kLines))];
  const double begins = random.chance(0.5) ? 0 : random.uniform(0, trouble_for);
  const double takes = random.uniform(5, trouble_for);
  if (world_.omits(kUnregistered)) return;
  rejection_ =
      random.chance(0.8) ? http_answer(line, kJson, "\"unknown robot\"") : http_answer(line, kPage, kHtml);
  world_.after(seconds(begins), [this, robot] { unregistered_ = calm_ ? "" : robot; });
  world_.after(seconds(begins + takes), [this] { unregistered_.clear(); });
}

void CommandPost::let_clerk(bool grants) {
  if (calm_) return;
  if (!scoreboard_.may_begin_run()) return world_.after(seconds(2), [this, grants] { let_clerk(grants); });
  grants ? scoreboard_.grant_report() : scoreboard_.set_clock_back();
}

void CommandPost::note(Fault fault, const std::string& path) {
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = path, .who = name_of(fault)});
}

void CommandPost::plan_periods(Fault fault, double trouble_for) {
  const bool is_long = fault == Fault::Outage || fault == Fault::Mute || fault == Fault::StatusDown;
  for (std::uint64_t i = 1 + random_.uniform_index(2); i > 0; --i) {
    const double begins = random_.uniform(1, trouble_for);
    const double takes = random_.uniform(0.5, is_long ? kLongestOutage : kLongest);
    if (world_.omits(name_of(fault))) continue;
    world_.after(seconds(begins), [this, fault, takes] { begin(fault, takes); });
  }
}

void CommandPost::begin(Fault period, double takes) {
  if (calm_) return;
  if (period == Fault::NewRun) return begin_run();
  note(period, "begins");
  if (period == Fault::OtherSender) return scoreboard_.record_another();
  on_.insert(period);
  if (period == Fault::AdminStop) scoreboard_.stop(true);
  if (period == Fault::Outage) cut_all();
  world_.after(seconds(takes), [this, period] {
    on_.erase(period);
    if (period == Fault::AdminStop) scoreboard_.stop(false);
  });
}

void CommandPost::begin_run() {
  if (calm_) return;
  if (scoreboard_.may_begin_run()) return scoreboard_.begin_run();
  world_.after(seconds(5), [this] { begin_run(); });
}

void CommandPost::cut_all() {
  for (const auto& each : std::exchange(links_, {})) {
    if (const auto link = each.lock()) link->end(Link::How::Reset);
  }
}

void CommandPost::calm() {
  calm_ = true;
  on_.clear();
  has_portal_ = false;
  unregistered_.clear();
  scoreboard_.stop(false);
  world_.note({.actor = Actor::Post, .kind = Kind::Calm, .what = "", .who = ""});
}

std::optional<int> CommandPost::connecting(const uplink::Endpoint&) {
  if (is_on(Fault::Deaf) || is_on(Fault::Mute)) return std::nullopt;
  return is_on(Fault::Refused) || is_on(Fault::Outage) ? ECONNREFUSED : 0;
}

std::unique_ptr<Peer> CommandPost::connected(const uplink::Endpoint& endpoint, Link& link) {
  links_.push_back(link.weak_from_this());
  if (!is_serial_) return std::make_unique<Reader>(*this, link);
  return std::make_unique<SerialReader>(*this, link, accepted_[{endpoint.address, endpoint.port}]);
}

/// Ignores requests on a connection that Adit has closed.
void CommandPost::asked(const HttpMessage& request, const WhenLeft& left, Link& link) {
  connection_ = link.number();
  if (is_on(Fault::Mute) || is_on(Fault::Outage)) return;
  if (is_on(Fault::StatusDown) && request.path() == kStatus) return;
  if (is_too_large(request, link) || has_page_for(request, link) || redirects(request, link) ||
      refuses(request, left, link))
    return;
  if (!rejects_robot(request, link)) answer(request, link);
  if (!is_mapping(request) || link.is_closed()) return;
  const auto count = [this, path = request.path(), left, self = link.shared_from_this()] {
    if (!self->is_closed()) counting_.count(path, left, world_.now());
  };
  count();
  if (link.answers_until() > world_.now()) world_.at(link.answers_until(), count);
}

/// Whether a client posted all of it in one message.
bool CommandPost::is_single(const std::vector<Item>& sent) const {
  const auto is_in = [&](const std::vector<Item>& posted) {
    return std::ranges::all_of(sent, [&](const Item& item) {
      return std::ranges::any_of(posted, [&](const Item& each) {
        if (!is_grid(item.says)) return each.serial == item.serial;
        return is_grid(each.says) &&
               std::ranges::equal(std::span(item.says).first(kExtentNumbers), each.says);
      });
    });
  };
  return std::ranges::any_of(world_.posted_maps, is_in);
}

/// Resets the connection as soon as the bytes within the limit have arrived, as some servers do.
bool CommandPost::cuts_large(const HttpStream& stream, Link& link) {
  const bool is_large = stream.head()->path() == kMap && stream.length() > largest_;
  if (!world_.has_large_maps() || !resets_large_ || calm_ || !is_large || stream.read() < largest_)
    return false;
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = kMap, .who = kTooLarge});
  link.go_deaf();
  link.end(Link::How::Reset);
  return true;
}

/// As nginx with client_max_body_size. Its limit is above each posted map, or becomes so with calm(). Large
/// maps can be split, so then it stays as it is.
bool CommandPost::is_too_large(const HttpMessage& request, Link& link) {
  if (request.path() != kMap || request.body.size() <= largest_) return false;
  if (!world_.has_large_maps() && (calm_ || !is_below_single_) && is_single(items_of(request))) return false;
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = kMap, .who = kTooLarge});
  if (resets_large_ && !calm_) {
    link.end(Link::How::Reset);
  } else {
    link.send(
        http_answer("413 Request Entity Too Large", std::string(kPage) + "Connection: close\r\n", kHtml));
    link.end(Link::How::End);
  }
  return true;
}

/// Answers with a web page, or 404 to a path that scoring does not know.
bool CommandPost::has_page_for(const HttpMessage& request, Link& link) {
  if (is_mapping(request)) return false;
  const bool is_unknown = slash_ == Slash::Unknown && request.has_slash();
  const bool is_page = has_portal_ || (slash_ == Slash::Wanted && !request.has_slash());
  if (is_page || is_unknown)
    link.send(is_page ? http_answer("200 OK", kPage, kHtml)
                      : http_answer("404 Not Found", kJson, "\"no such URI\""));
  return is_page || is_unknown;
}

/// As Starlette (307) and Flask (308) do, which then have not read the report.
bool CommandPost::redirects(const HttpMessage& request, Link& link) {
  if (redirects_reports_ == 0 || request.path() != kReports || request.has_slash()) return false;
  const bool is_flask = redirects_reports_ == 308;
  link.send(http_answer(is_flask ? "308 Permanent Redirect" : "307 Temporary Redirect",
                        std::string("Location: ") + kReports + "/\r\n" + (is_flask ? kPage : ""),
                        is_flask ? kHtml : ""));
  return true;
}

/// Answers 429.
bool CommandPost::refuses(const HttpMessage& request, const WhenLeft& left, Link& link) {
  if (is_on(Fault::Storm) || is_on(Fault::PoliteStorm)) {
    const std::string after = is_on(Fault::PoliteStorm) ? retry_after(pausing_, World::kEpoch + world_.time(),
                                                                      1 + random_.uniform_index(4))
                                                        : std::string();
    link.send(http_answer("429 Too Many Requests", kJson + after, "\"too many requests\""));
    return true;
  }
  if (is_beyond_one_limit(request, left)) {
    world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = request.path(), .who = kBeyondOneLimit});
    link.send(http_answer("429 Too Many Requests", kJson, "\"too many requests\""));
    return true;
  }
  if (!is_mapping(request) || link.is_closed() || !counting_.is_too_soon(request.path(), left)) return false;
  world_.note({.actor = Actor::Post,
               .kind = Kind::Fault,
               .what = request.path(),
               .who = kTooSoon,
               .serial = static_cast<std::int64_t>(counting_.what()),
               .stamp = world_.time() - std::chrono::duration<double>(world_.now() - left.first).count()});
  link.send(http_answer("429 Too Many Requests", kJson, "\"too soon\""));
  return true;
}

/// Rejects states with the pose of an unregistered robot, and markers of its namespaces.
bool CommandPost::rejects_robot(const HttpMessage& request, Link& link) {
  const std::string path = request.path();
  if (unregistered_.empty() || (path != kState && path != kMarkers)) return false;
  const auto items = items_of(request);
  const bool has_it = std::ranges::any_of(items, [this](const Item& item) {
    return item.who == unregistered_ || item.who.starts_with(unregistered_ + " ");
  });
  if (!has_it) return false;
  world_.note(
      {.actor = Actor::Post, .kind = Kind::Fault, .what = path, .who = kUnregistered, .text = unregistered_});
  link.send(rejection_);
  return true;
}

bool CommandPost::is_beyond_one_limit(const HttpMessage& request, const WhenLeft& left) {
  if (!has_one_limit_ || is_mapping(request)) return false;
  if (asked_ && left.first - *asked_ < kOneLimit) return true;
  asked_ = left.first;
  return false;
}

/// Loses the answer to the late reporter's report, which it may record. True: this is that report.
bool CommandPost::loses_late_answer(const HttpMessage& request, Link& link) {
  if (!calm_ || is_late_lost_ || request.path() != kReports) return false;
  const auto items = items_of(request);
  if (items.empty() || items.front().serial != LateReporter::kSerial) return false;
  is_late_lost_ = true;
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = kReports, .who = kLate});
  if (world_.random("late answer").chance(0.5)) take(request);
  link.end(Link::How::Reset);
  return true;
}

void CommandPost::answer(const HttpMessage& request, Link& link) {
  if (loses_late_answer(request, link)) return;
  const bool fails = request.path() == kMap && failing_.chance(fails_maps_);
  const Fault fault = calm_ ? Fault::End : fails ? Fault::Error : faults_.of_request();
  const bool befalls = fault == Fault::Unwanted         ? request.path() == kMap || request.path() == kState
                       : fault == Fault::TakenThrottled ? is_mapping(request)
                                                        : true;
  if (fault != Fault::End && befalls && !world_.omits(name_of(fault))) return misbehave(fault, request, link);
  const std::string said = take(request);
  link.send(gzips_ ? gzipped(said) : said, seconds(random_.uniform(0, 0.01)));
}

/// Answers 200 to an incomplete message. Its rest never arrives, so it is not accepted.
void CommandPost::may_answer_early(const HttpMessage& head, Link& link) {
  const bool does = early_.chance(answers_early_);
  const auto resets = seconds(early_.uniform(0, 0.5));
  if (!does || calm_ || is_on(Fault::Mute) || !is_mapping(head) || world_.omits(kEarly)) return;
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = head.path(), .who = kEarly});
  link.go_deaf();
  link.send(http_answer("200 OK", kJson, "null"));
  link.end(Link::How::Reset, resets);
}

std::optional<std::string> CommandPost::repeat_last_answer(const Item& item) {
  const bool does = repeating_.chance(repeats_);
  const auto last = scoreboard_.last_answer(item);
  if (!does || calm_ || !last || world_.omits(kRepeats)) return std::nullopt;
  world_.note({.actor = Actor::Post, .kind = Kind::Fault, .what = kReports, .who = kRepeats});
  return last;
}

void CommandPost::take_later(const HttpMessage& request, double within) {
  world_.after(seconds(random_.uniform(0, within)), [this, request] { take(request); });
}

/// Decides the time of the answer and the fate of the connection.
void CommandPost::misbehave(Fault fault, const HttpMessage& request, Link& link) {
  note(fault, request.path());
  const auto soon = seconds(random_.uniform(0, 0.5));
  switch (fault) {
    case Fault::LostBefore:
      return link.end(Link::How::Reset, soon);
    case Fault::LostAfter:
      request.path() == kReports&& random_.chance(0.5) ? take_later(request, kLatest) : void(take(request));
      return link.end(Link::How::Reset, soon);
    case Fault::Delay: {
      const auto late = seconds(random_.uniform(0.1, kLatest));
      if (request.path() != kReports) return link.send(take(request), late);
      world_.after(late, [this, request, self = link.shared_from_this()] { self->send(take(request)); });
      return;
    }
    case Fault::Silence:
      if (random_.chance(0.5)) take(request);
      return;
    case Fault::CutAnswer:
    case Fault::HugeChunk:
    case Fault::WrongLength:
    case Fault::Garbage:
    case Fault::ClosesAfter:
      link.send(bad_answer(fault, request), soon);
      return link.end(random_.chance(0.5) ? Link::How::End : Link::How::Reset, soon);
    default:
      return link.send(bad_answer(fault, request), soon);
  }
}

/// The bytes of the faulty answer, and whether the request was recorded.
std::string CommandPost::bad_answer(Fault fault, const HttpMessage& request) {
  const auto maybe_take = [&] {
    if (random_.chance(0.5)) take(request);
  };
  switch (fault) {
    case Fault::CutAnswer: {
      const std::string answer = take(request);
      return answer.substr(0, random_.uniform_index(answer.size()));
    }
    case Fault::Error:
      maybe_take();
      return random_.chance(0.5) ? http_answer("500 Internal Server Error", kJson, "\"failed\"")
                                 : http_answer("500 Internal Server Error", kPage, kHtml);
    case Fault::Html:
      return http_answer("200 OK", kPage, kHtml);
    case Fault::HugeLength:
      maybe_take();
      return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nContent-Length: 1000000000000\r\n\r\n{";
    case Fault::HugeChunk:
      take(request);
      return "HTTP/1.1 200 OK\r\nContent-Type: application/json\r\nTransfer-Encoding: "
             "chunked\r\n\r\n6fc23ac00\r\n{";
    case Fault::WrongLength:
      return with_wrong_length(take(request), random_);
    case Fault::Garbage:
      take(request);
      return "\x16\x03\x01 this is no HTTP at all\r\n\r\n";
    case Fault::WrongTypes:
      take(request);
      return with_wrong_types(random_);
    case Fault::Redirect:
      maybe_take();
      return redirect(random_);
    case Fault::Between:
      maybe_take();
      return from_between(random_, pausing_.chance(0.5) ? retry_after(pausing_, World::kEpoch + world_.time(),
                                                                      1 + pausing_.uniform_index(10))
                                                        : "");
    case Fault::Unwanted:
      return http_answer("422 Unprocessable Entity", kJson, "\"Unknown field: 'x'\"");
    case Fault::TakenThrottled:
      take(request);
      return http_answer("429 Too Many Requests", kJson, "\"Cloud updates too frequent. Reduce to <1Hz.\"");
    case Fault::OddAnswer:
      return in_another_form(take(request), random_);
    default:
      return take(request);
  }
}

std::string CommandPost::take(const HttpMessage& request) {
  const std::string path = request.path();
  if (path == kStatus) return scoreboard_.status();
  const auto items = items_of(request);
  if (items.empty()) return http_answer("422 Unprocessable Entity", kJson, "\"what is this?\"");
  if (path == kReports) {
    const auto repeated = repeat_last_answer(items.front());
    return repeated ? *repeated : scoreboard_.record(items.front(), request);
  }
  for (const Item& item : items) {
    world_.note({.actor = Actor::Post,
                 .kind = Kind::Taken,
                 .what = path,
                 .who = item.who,
                 .serial = item.serial,
                 .stamp = item.stamp,
                 .request = connection_,
                 .says = item.says});
  }
  return http_answer("200 OK", kJson, "null");
}

}  // namespace adit::simulation
