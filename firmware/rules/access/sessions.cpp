#include "access/sessions.hpp"

#include <algorithm>

#include "access/role.hpp"
#include "codec/json.hpp"
#include "icd/text.hpp"

namespace adit::access {
namespace {

using codec::Field;
using codec::Value;

constexpr std::int64_t kSessionFileVersion = 1;

Value value_of(Instant at) {
  return {std::int64_t{std::chrono::duration_cast<Duration>(at.time_since_epoch()).count()}};
}

Instant instant_in(const Field& object, std::string_view name) {
  return Instant(Duration(object.member(name).integer<std::int64_t>(0)));
}

std::uint64_t number_in(const Field& object, std::string_view name) {
  return static_cast<std::uint64_t>(object.member(name).integer<std::int64_t>(0));
}

Value value_of(const Session& session) {
  return {Value::Object{{"number", {session.number}},
                        {"role", {std::string(name_of(session.role))}},
                        {"id", {session.id.reveal()}},
                        {"csrf", {session.csrf.reveal()}},
                        {"made", value_of(session.made)},
                        {"seen", value_of(session.seen)},
                        {"address", {session.address}},
                        {"agent", {session.agent}}}};
}

std::optional<Session> session_in(const Field& object) {
  const auto role = role_in(object);
  const auto id = token_in(object, "id"), csrf = token_in(object, "csrf");
  if (!role || !id || !csrf) return std::nullopt;
  return Session{.number = number_in(object, "number"),
                 .role = *role,
                 .id = *id,
                 .csrf = *csrf,
                 .made = instant_in(object, "made"),
                 .seen = instant_in(object, "seen"),
                 .address = std::string(object.member("address").text()),
                 .agent = std::string(object.member("agent").text())};
}

/// The text with "?" for all but visible ASCII and spaces, so that it can be shown anywhere.
std::string plain(std::string_view agent) {
  std::string text(agent.substr(0, Sessions::kLongestAgent));
  std::ranges::replace_if(text, [](char letter) { return letter < 0x20 || letter > 0x7e; }, '?');
  return text;
}

}  // namespace

std::string write_sessions(const KeptSessions& kept) {
  Value::Array sessions;
  for (const Session& session : kept.sessions) sessions.push_back(value_of(session));
  return codec::write_json({Value::Object{{"version", {kSessionFileVersion}},
                                          {"boot", {kept.boot}},
                                          {"last", {kept.last}},
                                          {"sessions", {std::move(sessions)}}}}) +
         '\n';
}

std::expected<KeptSessions, std::string> read_sessions(std::string_view json) {
  return read_kept<KeptSessions>(json, kSessionFileVersion, [](const Field& object) {
    return KeptSessions{.boot = std::string(object.member("boot").text()),
                        .last = number_in(object, "last"),
                        .sessions = elements_of<Session>(object.member("sessions"), session_in)};
  });
}

icd::BearerToken to_token(const Secret& secret) {
  return *icd::BearerToken::parse(icd::hex(secret));
}

void Sessions::restore(std::vector<Session> sessions, std::uint64_t last, Instant now) {
  sessions_ = std::move(sessions);
  std::erase_if(sessions_, [now](const Session& each) { return each.seen > now || each.made > each.seen; });
  if (sessions_.size() > kMost) sessions_.erase(sessions_.begin(), sessions_.end() - kMost);
  last_ = last;
  for (const Session& each : sessions_) last_ = std::max(last_, each.number);
  forget_ended(now);
}

const Session& Sessions::begin(const Secret& id, const Secret& csrf, Role role, const Caller& caller,
                               Instant now) {
  forget_ended(now);
  if (sessions_.size() >= kMost) {
    // Viewers first, so that a viewer cannot end an operator's session.
    const auto by = [](const Session& each) { return std::pair(each.role == Role::Operator, each.seen); };
    sessions_.erase(std::ranges::min_element(sessions_, {}, by));
  }
  sessions_.push_back({.number = ++last_,
                       .role = role,
                       .id = to_token(id),
                       .csrf = to_token(csrf),
                       .made = now,
                       .seen = now,
                       .address = caller.address,
                       .agent = plain(caller.agent)});
  notify_changed();
  return sessions_.back();
}

const Session* Sessions::find(std::string_view id, Instant now) {
  forget_ended(now);
  Session* found = nullptr;
  for (Session& session : sessions_) {
    if (session.id.matches(id)) found = &session;  // no early exit: constant time
  }
  if (found != nullptr) found->seen = now;
  return found;
}

bool Sessions::touch(std::uint64_t number, Instant now) {
  forget_ended(now);
  const auto found = std::ranges::find(sessions_, number, &Session::number);
  if (found == sessions_.end()) return false;
  found->seen = now;
  return true;
}

bool Sessions::end(std::uint64_t number) {
  const bool ended =
      std::erase_if(sessions_, [number](const Session& each) { return each.number == number; }) > 0;
  if (ended) notify_changed();
  return ended;
}

void Sessions::end_all(Role role, std::uint64_t but) {
  std::erase_if(sessions_, [=](const Session& each) { return each.role == role && each.number != but; });
  notify_changed();
}

std::vector<Session> Sessions::all(Instant now) {
  forget_ended(now);
  return {sessions_.rbegin(), sessions_.rend()};
}

void Sessions::forget_ended(Instant now) {
  std::erase_if(sessions_, [now](const Session& each) {
    return now - each.seen >= kIdle || now - each.made >= kLongest;
  });
}

}  // namespace adit::access
