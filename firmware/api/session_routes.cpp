#include "api/session_routes.hpp"

#include <utility>

#include "access/password.hpp"
#include "api/answers.hpp"
#include "api/as_json.hpp"
#include "api/number_in.hpp"
#include "api/small_body.hpp"
#include "codec/body_decoder.hpp"
#include "codec/field.hpp"
#include "codec/json.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

using access::Role;
using codec::Value;

constexpr std::string_view kSession = "/adit/session", kSessions = "/adit/sessions", kLogin = "/adit/login",
                           kLogout = "/adit/logout", kPassword = "/adit/password", kOne = "/adit/sessions/",
                           kEnd = "/end", kReset = "/adit/reset";
constexpr std::size_t kMostBody = 4096;

/// Of "/adit/sessions/7/end".
std::optional<std::uint64_t> ended_by(std::string_view path) {
  if (!path.starts_with(kOne) || !path.ends_with(kEnd) || path.size() < kOne.size() + kEnd.size()) {
    return std::nullopt;
  }
  return number_in<std::uint64_t>(path.substr(kOne.size(), path.size() - kOne.size() - kEnd.size()));
}

intake::Header cookie(const std::string& id, std::chrono::seconds age) {
  return {"Set-Cookie", std::string(access::kCookie) + "=" + id +
                            "; HttpOnly; SameSite=Strict; Path=/; Max-Age=" + std::to_string(age.count())};
}

intake::Answer slow_down(access::Duration wait) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(wait).count();
  auto answer = refusal(icd::Status::TooManyRequests, icd::sentence("wait ", seconds, " s and try again"));
  answer.headers.push_back({"Retry-After", std::to_string(seconds)});
  return answer;
}

intake::Answer refused(const icd::Refusal& why) {
  return refusal(why.status, why.sentence);
}

intake::Answer wrong(std::string_view what) {
  return refusal(icd::Status::Forbidden, icd::sentence("that is not ", what));
}

intake::Answer object(Value::Object members) {
  return fresh("application/json", codec::write_json({std::move(members)}));
}

/// A string member; "" where it is absent.
std::string text_in(const codec::Field& object, std::string_view name) {
  const codec::Field field = object.member(name);
  return field.is_absent() ? "" : std::string(field.text());
}

/// What `read` makes of a body, which is one JSON object.
template <class Message, class Read>
icd::Checked<Message> read_body(const std::string& body, Read read) {
  const auto root = codec::parse_json(body);
  if (!root) return std::unexpected(icd::Refusal{icd::Status::BadRequest, "expected JSON: " + root.error()});
  codec::Reading reading;
  return reading.outcome<Message>(read(codec::Field(*root, reading)));
}

}  // namespace

bool SessionRoutes::has(std::string_view path) {
  return path == kSession || path == kSessions || path == kLogin || path == kLogout || path == kPassword ||
         path == kReset || ended_by(path).has_value();
}

std::unique_ptr<intake::BodySink> SessionRoutes::open(const intake::RequestHead& head,
                                                      std::shared_ptr<intake::Responder> responder) {
  if (const auto whence = access::check_whence(request_of(head)); !whence) {
    responder->answer(turned_away(whence.error()));
    return nullptr;
  }
  const bool shows = head.path() == kSession || head.path() == kSessions;
  if (shows) {
    responder->answer(only_reads(head) ? shown(head) : wrong_method(kReading));
    return nullptr;
  }
  if (head.method() != "POST") {
    responder->answer(wrong_method("POST"));
    return nullptr;
  }
  if (codec::format_of(head.header("Content-Type")) != codec::Format::Json) {
    responder->answer(refusal(icd::Status::UnprocessableEntity, "Content-Type: expected application/json"));
    return nullptr;
  }
  return post(head, std::move(responder));
}

intake::Answer SessionRoutes::shown(const intake::RequestHead& head) {
  if (head.path() == kSession) return session(head);
  return sessions(head);
}

intake::Answer SessionRoutes::session(const intake::RequestHead& head) {
  const auto visitor = entrance_.who(head);
  const auto* const session = visitor ? visitor->session : nullptr;
  return object({{"role", visitor ? json(std::string(name_of(visitor->role))) : Value{}},
                 {"csrf", session != nullptr ? json(session->csrf.reveal()) : Value{}},
                 {"first_start", json(keys_.first_start())},
                 {"set_up_open", json(keys_.set_up_open())}});
}

intake::Answer SessionRoutes::sessions(const intake::RequestHead& head) {
  const auto visitor = entrance_.admit(head, Role::Operator);
  if (!visitor) return turned_away(visitor.error());
  const std::uint64_t own = visitor->session != nullptr ? visitor->session->number : 0;
  const auto now = loop_.now();
  const auto time = [&](access::Instant at) {
    return json(loop_.stamp_now() - std::chrono::duration<double>(now - at).count());
  };
  Value::Array rows;
  for (const access::Session& each : entrance_.sessions().all(now)) {
    rows.push_back({Value::Object{{"number", json(each.number)},
                                  {"role", json(std::string(name_of(each.role)))},
                                  {"address", json(each.address)},
                                  {"agent", json(each.agent)},
                                  {"made", time(each.made)},
                                  {"seen", time(each.seen)},
                                  {"own", json(each.number == own)}}});
  }
  return fresh("application/json", codec::write_json({std::move(rows)}));
}

std::unique_ptr<intake::BodySink> SessionRoutes::post(const intake::RequestHead& head, Replies responder) {
  if (const auto number = ended_by(head.path())) {
    responder->answer(end(head, *number));
    return nullptr;
  }
  if (head.path() == kLogout) {
    responder->answer(log_out(head));
    return nullptr;
  }
  const auto visitor = entrance_.admit(head, Role::Operator);
  const bool open_to_all =
      head.path() == kLogin || (head.path() == kPassword && (keys_.first_start() || keys_.set_up_open()));
  if (!visitor && !open_to_all) {
    responder->answer(turned_away(visitor.error()));
    return nullptr;
  }
  Poster poster{.address = head.peer(), .agent = std::string(head.header("User-Agent"))};
  poster.admitted = visitor.has_value();
  if (const auto known = entrance_.who(head); known && known->session != nullptr) {
    poster.session = known->session->number;
  }
  const auto handle = head.path() == kLogin   ? &SessionRoutes::log_in
                      : head.path() == kReset ? &SessionRoutes::reset
                                              : &SessionRoutes::change_password;
  return std::make_unique<SmallBody>(
      responder, kMostBody, [this, handle, poster = std::move(poster), responder](const std::string& body) {
        (this->*handle)(poster, body, responder);
      });
}

bool SessionRoutes::may_try(const Poster& poster, const Replies& responder) {
  const auto wait = checking_ < kMostChecks ? failures_.begin(poster.address, loop_.now())
                                            : access::Duration(std::chrono::seconds(1));
  if (wait > access::Duration::zero()) responder->answer(slow_down(wait));
  return wait == access::Duration::zero();
}

template <class Done>
void SessionRoutes::check(const std::string& password, const Poster& poster, const Replies& responder,
                          Done done) {
  if (!may_try(poster, responder)) return;
  ++checking_;
  keys_.check(password, poster.address,
              [this, address = poster.address, done = std::move(done)](std::optional<Role> role) {
                --checking_;
                if (role) failures_.succeeded(address);
                done(role);
              });
}

void SessionRoutes::log_in(const Poster& poster, const std::string& body, const Replies& responder) {
  const auto password = read_body<std::string>(
      body, [](const codec::Field& root) { return std::string(root.member("password").text()); });
  if (!password) return responder->answer(refused(password.error()));
  if (keys_.first_start()) {
    return responder->answer(refusal(icd::Status::Conflict, "no password is set yet: set one with the code"));
  }
  check(*password, poster, responder, [this, poster, responder](std::optional<Role> role) {
    responder->answer(role ? logged_in(*role, poster) : wrong("the password"));
  });
}

intake::Answer SessionRoutes::logged_in(Role role, const Poster& poster) {
  entrance_.sessions().end(poster.session);  // what the browser had before, it has no longer
  const access::Session& session = entrance_.sessions().begin(keys_.draw(), keys_.draw(), role,
                                                              {poster.address, poster.agent}, loop_.now());
  auto answer = object({{"role", json(std::string(name_of(role)))}, {"csrf", json(session.csrf.reveal())}});
  answer.headers.push_back(cookie(session.id.reveal(), access::Sessions::kLongest));
  return answer;
}

intake::Answer SessionRoutes::log_out(const intake::RequestHead& head) {
  const auto visitor = entrance_.admit(head, Role::Viewer);
  if (!visitor) return turned_away(visitor.error());
  if (visitor->session != nullptr) entrance_.sessions().end(visitor->session->number);
  auto answer = object({{"role", {}}});
  answer.headers.push_back(cookie("", std::chrono::seconds(0)));
  return answer;
}

intake::Answer SessionRoutes::end(const intake::RequestHead& head, std::uint64_t number) {
  const auto visitor = entrance_.admit(head, Role::Operator);
  if (!visitor) return turned_away(visitor.error());
  if (entrance_.sessions().end(number)) return object({{"session", json(number)}});
  return refusal(icd::Status::NotFound, icd::sentence("there is no session ", number));
}

icd::Checked<SessionRoutes::Change> SessionRoutes::read_change(const std::string& body) {
  return read_body<Change>(body, [](const codec::Field& root) {
    Change change{.role = Role::Operator,
                  .password = {},
                  .current = text_in(root, "current"),
                  .code = text_in(root, "code")};
    const codec::Field role = root.member("role"), password = root.member("password");
    const auto named = access::role_named(role.text());
    if (!named) role.refuse("expected operator or viewer");
    change.role = named.value_or(Role::Operator);
    if (change.role == Role::Viewer && password.is<std::nullptr_t>()) return change;
    change.password = password.text();
    if (const auto fit = access::check_new(*change.password); !fit) password.refuse(fit.error());
    return change;
  });
}

/// There is nothing to guess: whoever comes while set-up is open may, and he who opened it sees at the box
/// when it is closed.
bool SessionRoutes::is_by_button(const Change& change) const {
  return keys_.set_up_open() && change.role == Role::Operator && change.current.empty() &&
         change.code.empty();
}

void SessionRoutes::change_password(const Poster& poster, const std::string& body, const Replies& responder) {
  const auto change = read_change(body);
  if (!change) return responder->answer(refused(change.error()));
  if (is_by_button(*change)) return set(*change, poster, responder);
  if (keys_.first_start()) {
    if (change->role != Role::Operator) {
      return responder->answer(refusal(icd::Status::Conflict, "the operator's password is set first"));
    }
    if (!may_try(poster, responder)) return;
    if (!keys_.is_code(change->code)) return responder->answer(wrong("the code"));
    failures_.succeeded(poster.address);
    return set(*change, poster, responder);
  }
  if (!poster.admitted) {  // somebody else set it while this was on its way, or it is the viewers'
    return responder->answer(turned_away({icd::Status::Unauthorized, "log in: a password has been set"}));
  }
  check(change->current, poster, responder,
        [this, change = *change, poster, responder](std::optional<Role> role) {
          if (role != Role::Operator) return responder->answer(wrong("the operator's present password"));
          set(change, poster, responder);
        });
}

void SessionRoutes::reset(const Poster& poster, const std::string& body, const Replies& responder) {
  const auto password = read_body<std::string>(
      body, [](const codec::Field& root) { return std::string(root.member("password").text()); });
  if (!password) return responder->answer(refused(password.error()));
  if (setup_ == nullptr) return responder->answer(nothing_here());
  if (keys_.first_start()) {
    return responder->answer(refusal(icd::Status::Conflict, "no password is set yet: set one with the code"));
  }
  check(*password, poster, responder, [this, responder](std::optional<Role> role) {
    if (role != Role::Operator) return responder->answer(wrong("the operator's present password"));
    if (const auto done = setup_->reset(); !done) return responder->answer(refused(done.error()));
    auto answer =
        object({{"said", {"settings, tokens, passwords and sessions are gone; the reports are kept"}}});
    answer.headers.push_back(cookie("", std::chrono::seconds(0)));
    responder->answer(std::move(answer));
  });
}

void SessionRoutes::set(const Change& change, const Poster& poster, const Replies& responder) {
  keys_.set(change.role, change.password,
            [this, role = change.role, own = poster.session, responder](const icd::Checked<void>& kept) {
              if (!kept) return responder->answer(refused(kept.error()));
              entrance_.sessions().end_all(role, own);
              responder->answer(object({{"role", json(std::string(name_of(role)))}}));
            });
}

}  // namespace adit::api
