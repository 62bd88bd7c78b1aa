#include "access/session_file.hpp"

#include "access/fields.hpp"
#include "codec/json.hpp"

namespace adit::access {
namespace {

using codec::Field;
using codec::Value;

constexpr std::int64_t kSessionFileVersion = 1;

Value value_of(Instant at) {
  return {std::int64_t{std::chrono::duration_cast<Duration>(at.time_since_epoch()).count()}};
}

Instant instant_in(const Field& object, std::string_view name) {
  return Instant(Duration(object.member(name).whole<std::int64_t>(0)));
}

std::uint64_t number_in(const Field& object, std::string_view name) {
  return static_cast<std::uint64_t>(object.member(name).whole<std::int64_t>(0));
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

}  // namespace adit::access
