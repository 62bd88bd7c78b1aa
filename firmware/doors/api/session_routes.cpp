#include "api/session_routes.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "access/password.hpp"
#include "api/answers.hpp"
#include "api/route.hpp"
#include "codec/field.hpp"
#include "codec/row.hpp"
#include "icd/sentence.hpp"

namespace adit::api {
namespace {

using access::Role;
using codec::json;

/// `host`: the request's Host header. `is_secure`: it came by TLS.
intake::Header cookie(std::string_view name, std::string_view host, bool is_secure, const std::string& id,
                      std::chrono::seconds age) {
  return {"Set-Cookie", access::cookie_name(name, host, is_secure) + "=" + id +
                            "; HttpOnly; SameSite=Strict; Path=/; Max-Age=" + std::to_string(age.count()) +
                            (is_secure ? "; Secure" : "")};
}

intake::Header no_session(std::string_view host, bool is_secure) {
  return cookie(access::kCookie, host, is_secure, "", std::chrono::seconds(0));
}

constexpr std::chrono::hours kDeviceKept{400 * 24};  // the longest lifetime that browsers accept (RFC
                                                     // 6265bis)

intake::Answer slow_down(const access::Wait& wait) {
  const auto seconds = std::chrono::ceil<std::chrono::seconds>(wait.left).count();
  auto answer =
      refusal(icd::Status::TooManyRequests,
              wait.for_others ? icd::sentence("other clients are trying passwords: wait ", seconds,
                                              " s, or press the box's button and try again at once")
                              : icd::sentence("too many attempts: wait ", seconds, " s and try again"));
  answer.headers.push_back({"Retry-After", std::to_string(seconds)});
  return answer;
}

intake::Answer wrong(std::string_view what) {
  return refusal(icd::Status::Forbidden, icd::sentence("that is not ", what));
}

/// A string member, or "" if absent.
std::string text_in(const codec::Field& object, std::string_view name) {
  const codec::Field field = object.member(name);
  return field.is_absent() ? "" : std::string(field.text());
}

}  // namespace

intake::Answer SessionRoutes::session(const intake::RequestHead& head) {
  const auto visitor = authenticator_.find_visitor(head);
  const auto* const session = visitor ? visitor->session : nullptr;
  return uncached_answer(
      SessionView{.role = visitor ? std::optional(visitor->role) : std::nullopt,
                  .csrf = session != nullptr ? std::string(session->csrf.reveal()) : std::string(),
                  .first_start = keys_.first_start(),
                  .set_up_open = keys_.set_up_open(),
                  .secure = head.is_secure(),
                  .https = certificate_.state().offered});
}

intake::Answer SessionRoutes::sessions(const Call& call) {
  const auto now = loop_.now();
  const auto time = [&](access::Instant at) {
    return loop_.wall_now() - std::chrono::duration<double>(now - at).count();
  };
  std::vector<SessionRow> rows;
  for (const access::Session& each : keys_.sessions().all(now)) {
    rows.push_back({.number = each.number,
                    .role = each.role,
                    .address = each.address,
                    .agent = each.agent,
                    .made = time(each.made),
                    .seen = time(each.seen),
                    .own = each.number == call.asker.session});
  }
  return uncached_answer(rows);
}

SessionRoutes::Poster SessionRoutes::poster_of(const Call& call) {
  const access::Device* const device = authenticator_.device(call.head);
  return {.guesser = {.address = call.head.peer(),
                      .device = device == nullptr ? 0 : device->number,
                      .at_box = keys_.is_operator_at_box()},
          .agent = std::string(call.head.header("User-Agent")),
          .host = std::string(call.head.header("Host")),
          .is_secure = call.head.is_secure(),
          .asker = call.asker,
          .responder = call.responder};
}

bool SessionRoutes::check_limit(const Poster& poster) {
  if (!keys_.unread().empty()) {
    poster.responder->answer(refusal(icd::Status::ServiceUnavailable, keys_.unread()));
    return false;
  }
  const access::Wait wait = checking_ < kMostChecks ? guesses_.begin(poster.guesser, loop_.now())
                                                    : access::Wait{.left = std::chrono::seconds(1)};
  if (wait.left > access::Duration::zero()) poster.responder->answer(slow_down(wait));
  return wait.left == access::Duration::zero();
}

template <class Done>
void SessionRoutes::check_posted(const Call& call, Done done) {
  const Poster poster = poster_of(call);
  const auto password = read_text(call.body, "password");
  if (!password) return poster.responder->answer(refusal_answer(password.error()));
  if (keys_.first_start()) {
    return poster.responder->answer(
        refusal(icd::Status::Conflict, "no password is set yet: set one with the code"));
  }
  check(*password, poster, [poster, done](std::optional<Role> role) { done(role, poster); });
}

template <class Done>
void SessionRoutes::check(const std::string& password, const Poster& poster, Done done) {
  if (!check_limit(poster)) return;
  ++checking_;
  keys_.check(password, poster.guesser.address,
              [this, guesser = poster.guesser, done = std::move(done)](std::optional<Role> role) {
                --checking_;
                if (role) guesses_.on_succeeded(guesser, *role);
                done(role);
              });
}

void SessionRoutes::log_in(const Call& call) {
  check_posted(call, [this](std::optional<Role> role, const Poster& poster) {
    poster.responder->answer(role ? logged_in(*role, poster) : wrong("the password"));
  });
}

intake::Answer SessionRoutes::logged_in(Role role, const Poster& poster) {
  keys_.sessions().end(poster.asker.session);  // a login ends the browser's earlier session
  const access::Session& session = keys_.sessions().begin(
      keys_.draw(), keys_.draw(), role, {poster.guesser.address, poster.agent}, loop_.now());
  auto answer = object({{"role", json(std::string(name_of(role)))}, {"csrf", json(session.csrf.reveal())}});
  answer.headers.push_back(cookie(access::kCookie, poster.host, poster.is_secure, session.id.reveal(),
                                  access::Sessions::kLongest));
  if (const auto known = device_role(poster); !known || *known < role) {
    const access::Device& device = keys_.devices().add(keys_.draw(), role);
    answer.headers.push_back(
        cookie(access::kDeviceCookie, poster.host, poster.is_secure, device.id.reveal(), kDeviceKept));
  }
  return answer;
}

std::optional<Role> SessionRoutes::device_role(const Poster& poster) {
  const auto& devices = keys_.devices().all();
  const auto device = std::ranges::find(devices, poster.guesser.device, &access::Device::number);
  return device == devices.end() ? std::nullopt : std::optional(device->role);
}

intake::Answer SessionRoutes::log_out(const Call& call) {
  keys_.sessions().end(call.asker.session);
  auto answer = object({{"role", {}}});
  answer.headers.push_back(no_session(call.head.header("Host"), call.head.is_secure()));
  return answer;
}

intake::Answer SessionRoutes::end(std::uint64_t number) {
  if (keys_.sessions().end(number)) return object({{"session", json(number)}});
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

/// Checks no secret, because any client may set the password while set-up is open. The box shows its end.
bool SessionRoutes::is_by_button(const Change& change) const {
  return keys_.set_up_open() && change.role == Role::Operator && change.current.empty() &&
         change.code.empty();
}

void SessionRoutes::change_password(const Call& call) {
  const Poster poster = poster_of(call);
  const auto change = read_change(call.body);
  if (!change) return poster.responder->answer(refusal_answer(change.error()));
  if (is_by_button(*change)) return set(*change, poster);
  if (keys_.first_start()) {
    if (change->role != Role::Operator) {
      return poster.responder->answer(refusal(icd::Status::Conflict, "set the operator's password first"));
    }
    if (!check_limit(poster)) return;
    if (!keys_.is_code(change->code)) return poster.responder->answer(wrong("the code"));
    guesses_.on_succeeded(poster.guesser, Role::Operator);
    return set(*change, poster);
  }
  if (!poster.asker.admitted) {  // another client was faster, or the password is the viewers'
    return poster.responder->answer(
        rejection_answer({icd::Status::Unauthorized, "log in: a password has been set"}));
  }
  check(change->current, poster, [this, change = *change, poster](std::optional<Role> role) {
    if (role != Role::Operator) return poster.responder->answer(wrong("the operator's present password"));
    set(change, poster);
  });
}

void SessionRoutes::reset(const Call& call) {
  check_posted(call, [this](std::optional<Role> role, const Poster& poster) {
    if (role != Role::Operator) return poster.responder->answer(wrong("the operator's present password"));
    if (const auto done = setup_.reset(); !done)
      return poster.responder->answer(refused_change(done.error()));
    auto answer =
        object({{"said", {"settings, tokens, passwords and sessions are deleted; the reports are kept"}}});
    answer.headers.push_back(no_session(poster.host, poster.is_secure));
    poster.responder->answer(std::move(answer));
  });
}

void SessionRoutes::set(const Change& change, const Poster& poster) {
  keys_.set(change.role, change.password, [this, role = change.role, poster](const icd::Checked<void>& kept) {
    if (!kept) return poster.responder->answer(refusal_answer(kept.error()));
    keys_.sessions().end_all(role, poster.asker.session);
    keys_.devices().end_all(role, poster.guesser.device);
    poster.responder->answer(object({{"role", json(std::string(name_of(role)))}}));
  });
}

}  // namespace adit::api
