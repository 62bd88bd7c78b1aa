#include "update/messages.hpp"

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "network/file_object.hpp"
#include "network/messages.hpp"

namespace adit::update {
namespace {

using codec::Field;
using codec::Value;
using network::file_object::only;
using network::file_object::text;

constexpr std::string_view kFormat = "format";  // the member

constexpr std::pair<std::string_view, Request::What> kWhat[] = {{"install", Request::What::Install},
                                                                {"stick", Request::What::Stick},
                                                                {"restart", Request::What::Restart}};
constexpr Stage kStages[] = {Stage::None,      Stage::Installing, Stage::Interrupted, Stage::Failed,
                             Stage::Installed, Stage::Left,       Stage::Good};

std::string written(Value::Object members) {
  return network::file_object::written(kFormat, std::move(members));
}

template <class Message, class Make>
Read<Message> read(std::string_view json, std::initializer_list<std::string_view> names, Make make) {
  return network::file_object::read<Message>(json, kFormat, names, make);
}

Value last_update_json(const LastUpdate& last_update) {
  return {Value::Object{{"stage", {std::string(name_of(last_update.stage))}},
                        {"version", {last_update.version}},
                        {"slot", {last_update.slot}},
                        {"boot", {last_update.boot}},
                        {"why", {last_update.why}}}};
}

LastUpdate last_update_in(const Field& object) {
  LastUpdate last_update{.version = text(object, "version"),
                         .slot = text(object, "slot"),
                         .boot = text(object, "boot"),
                         .why = text(object, "why")};
  const Field field = object.member("stage");
  const auto* found = std::ranges::find(kStages, field.text(), name_of);
  if (found == std::end(kStages)) {
    field.refuse("expected a stage");
  } else {
    last_update.stage = *found;
  }
  return last_update;
}

Running running_in(const Field& object) {
  const Field field = object.member("running");
  only(field, {"compatible", "version", "slot", "other"});
  return {.compatible = text(field, "compatible"),
          .version = text(field, "version"),
          .slot = text(field, "slot"),
          .other = text(field, "other")};
}

std::optional<Offer> offer_in(const Field& object) {
  const Field field = object.member("stick");
  if (field.is_absent()) return std::nullopt;
  only(field, {"name", "version"});
  return Offer{text(field, "name"), text(field, "version")};
}

LastUpdate last_in(const Field& object) {
  const Field field = object.member("last");
  only(field, {"stage", "version", "slot", "boot", "why"});
  return last_update_in(field);
}

}  // namespace

std::string write(const Request& request) {
  const auto* what =
      std::ranges::find(kWhat, request.what, &std::pair<std::string_view, Request::What>::second);
  return written(
      {{"nonce", {request.nonce}}, {"what", {std::string(what->first)}}, {"again", {request.again}}});
}

std::string write(const Status& status) {
  const Running& running = status.running;
  return written({{"trouble", {status.trouble}},
                  {"running",
                   {Value::Object{{"compatible", {running.compatible}},
                                  {"version", {running.version}},
                                  {"slot", {running.slot}},
                                  {"other", {running.other}}}}},
                  {"nonce", {status.nonce}},
                  {"refusal", {status.refusal}},
                  {"doing", {status.doing}},
                  {"progress", status.progress ? Value{std::int64_t{*status.progress}} : Value{}},
                  {"last", last_update_json(status.last)},
                  {"trial", {status.trial}},
                  {"stick", status.stick ? Value{Value::Object{{"name", {status.stick->name}},
                                                               {"version", {status.stick->version}}}}
                                         : Value{}},
                  {"stick_trouble", {status.stick_trouble}}});
}

std::string write(const LastUpdate& last_update) {
  Value value = last_update_json(last_update);
  return written(std::move(std::get<Value::Object>(value.is)));
}

Read<Request> read_request(std::string_view json) {
  return read<Request>(json, {"nonce", "what", "again"}, [](const Field& root) {
    Request request{.nonce = text(root, "nonce"), .again = root.member("again").truth()};
    if (!network::is_nonce(request.nonce)) root.member("nonce").refuse("expected 32 hexadecimal digits");
    const Field field = root.member("what");
    const auto* what =
        std::ranges::find(kWhat, field.text(), &std::pair<std::string_view, Request::What>::first);
    if (what == std::end(kWhat)) {
      field.refuse("expected install, stick or restart");
    } else {
      request.what = what->second;
    }
    return request;
  });
}

Read<Status> read_status_file(std::string_view json) {
  return read<Status>(json,
                      {"trouble", "running", "nonce", "refusal", "doing", "progress", "last", "trial",
                       "stick", "stick_trouble"},
                      [](const Field& root) {
                        const Field progress = root.member("progress");
                        return Status{.trouble = text(root, "trouble"),
                                      .running = running_in(root),
                                      .nonce = text(root, "nonce"),
                                      .refusal = text(root, "refusal"),
                                      .doing = text(root, "doing"),
                                      .progress = progress.is_absent()
                                                      ? std::nullopt
                                                      : std::optional(progress.whole<int>(0, 100)),
                                      .last = last_in(root),
                                      .trial = root.member("trial").truth(),
                                      .stick = offer_in(root),
                                      .stick_trouble = text(root, "stick_trouble")};
                      });
}

Read<LastUpdate> read_last_update(std::string_view json) {
  return read<LastUpdate>(json, {"stage", "version", "slot", "boot", "why"},
                          [](const Field& root) { return last_update_in(root); });
}

}  // namespace adit::update
