#include "network/messages.hpp"

#include <initializer_list>
#include <utility>

#include "network/file_object.hpp"

namespace adit::network {
namespace {

using codec::Field;
using codec::Value;
using file_object::text;

constexpr std::string_view kVersion = "version";  // the member
constexpr std::size_t kNonceDigits = 32;

std::string written(Value::Object members) {
  return file_object::written(kVersion, std::move(members));
}

template <class Message, class Make>
Read<Message> read(std::string_view json, std::initializer_list<std::string_view> names, Make make) {
  return file_object::read<Message>(json, kVersion, names, make);
}

std::string nonce(const Field& object) {
  const Field field = object.member("nonce");
  std::string text(field.text());
  if (!is_nonce(text)) field.refuse("expected 32 hexadecimal digits");
  return text;
}

std::chrono::milliseconds within(const Field& object) {
  return std::chrono::milliseconds(
      object.member("confirm_within_ms").whole<std::int64_t>(kLeastWithin.count(), kMostWithin.count()));
}

Numbers numbers(const Field& object, std::string_view name) {
  const Field field = object.member(name);
  if (field.value() == nullptr) {
    field.refuse_kind("an object");
    return {};
  }
  auto read = read_numbers(*field.value());
  if (read) return *read;
  field.refuse(read.error().front().sentence());
  return {};
}

/// An IPv4 address, or "".
std::string address_or_none(const Field& object, std::string_view name) {
  const Field field = object.member(name);
  std::string text(field.text());
  if (!text.empty() && !settings::ipv4_of(text)) field.refuse("expected an IPv4 address, or none");
  return text;
}

Value json(const Endpoints& endpoints) {
  Value::Array list;
  for (const std::uint32_t each : endpoints.addresses) list.push_back({settings::ipv4_text(each)});
  return {std::move(list)};
}

Endpoints endpoints(const Field& object) {
  Endpoints all;
  const Field list = object.member("endpoints");
  const std::size_t count = list.size();
  if (count > kMostEndpoints) list.refuse("expected at most ", kMostEndpoints);
  for (std::size_t i = 0; i < count && !list.reading().refused(); ++i) {
    const Field field = list.element(i);
    const auto address = settings::ipv4_of(field.text());
    if (!address) {
      field.refuse("expected an IPv4 address");
    } else if (!all.addresses.empty() && all.addresses.back() >= *address) {
      field.refuse("expected them in order, and none twice");
    } else {
      all.addresses.push_back(*address);
    }
  }
  return all;
}

Ended ended(const Field& object) {
  const Field field = object.member("last");
  if (field.is_absent()) return Ended::NotYet;
  const std::string_view word = field.text();
  for (const Ended each : {Ended::Confirmed, Ended::TakenBack}) {
    if (word == name_of(each)) return each;
  }
  field.refuse("expected confirmed or taken back");
  return Ended::NotYet;
}

std::int64_t milliseconds(Instant instant) {
  return std::chrono::duration_cast<std::chrono::milliseconds>(instant.time_since_epoch()).count();
}

Value json(const std::optional<Pending>& pending) {
  if (!pending) return {};
  return {Value::Object{{"nonce", {pending->nonce}},
                        {"until_ms", {milliseconds(pending->until)}},
                        {"confirm_within_ms", {std::int64_t{pending->confirm_within.count()}}},
                        {"wanted", to_json(pending->wanted)}}};
}

std::optional<Pending> pending(const Field& object) {
  const Field field = object.member("pending");
  if (field.is_absent()) return std::nullopt;
  return Pending{nonce(field), numbers(field, "wanted"),
                 Instant(std::chrono::milliseconds(field.member("until_ms").whole<std::int64_t>(0))),
                 within(field)};
}

std::optional<Numbers> kept(const Field& object) {
  if (object.member("kept").is_absent()) return std::nullopt;
  return numbers(object, "kept");
}

}  // namespace

bool is_nonce(std::string_view text) {
  return text.size() == kNonceDigits && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::string_view name_of(Ended ended) {
  switch (ended) {
    case Ended::Confirmed:
      return "confirmed";
    case Ended::TakenBack:
      return "taken back";
    case Ended::NotYet:
      break;
  }
  return "";
}

std::string write(const Wanted& wanted) {
  return written({{"nonce", {wanted.nonce}},
                  {"confirm_within_ms", {std::int64_t{wanted.confirm_within.count()}}},
                  {"numbers", to_json(wanted.numbers)}});
}

std::string write(const Word& word) {
  return written({{"nonce", {word.nonce}},
                  {"word", {std::string(word.what == Word::What::Confirm ? "confirm" : "back")}}});
}

std::string write(const Probe& probe) {
  return written({{"nonce", {probe.nonce}}, {"sought", {probe.sought}}});
}

std::string write(const Endpoints& endpoints) {
  return written({{"endpoints", json(endpoints)}});
}

std::string write(const Forget& forget) {
  return written({{"nonce", {forget.nonce}}});
}

std::string write(const Status& status) {
  const std::string_view last = name_of(status.ended);
  return written({{"team_interface", {status.team_interface}},
                  {"command_post_interface", {status.command_post_interface}},
                  {"kept", status.kept ? to_json(*status.kept) : Value{}},
                  {"endpoints", json(status.endpoints)},
                  {"pending", json(status.pending)},
                  {"last", last.empty() ? Value{} : Value{std::string(last)}},
                  {"last_nonce", {status.ended_nonce}},
                  {"why", {status.why}}});
}

std::string write(const Probed& probed) {
  return written({{"nonce", {probed.nonce}},
                  {"address", {probed.address}},
                  {"claimant", {probed.claimant}},
                  {"own", {probed.own}},
                  {"found_on", {probed.found_on}},
                  {"trouble", {probed.trouble}}});
}

Read<Wanted> read_wanted(std::string_view json) {
  return read<Wanted>(json, {"nonce", "confirm_within_ms", "numbers"}, [](const Field& root) {
    return Wanted{nonce(root), within(root), numbers(root, "numbers")};
  });
}

Read<Word> read_word(std::string_view json) {
  return read<Word>(json, {"nonce", "word"}, [](const Field& root) {
    const Field field = root.member("word");
    const std::string_view word = field.text();
    if (word != "confirm" && word != "back") field.refuse("expected confirm or back");
    return Word{nonce(root), word == "confirm" ? Word::What::Confirm : Word::What::Back};
  });
}

Read<Probe> read_probe(std::string_view json) {
  return read<Probe>(json, {"nonce", "sought"},
                     [](const Field& root) { return Probe{nonce(root), address_or_none(root, "sought")}; });
}

Read<Endpoints> read_endpoints(std::string_view json) {
  return read<Endpoints>(json, {"endpoints"}, [](const Field& root) { return endpoints(root); });
}

Read<Forget> read_forget(std::string_view json) {
  return read<Forget>(json, {"nonce"}, [](const Field& root) { return Forget{nonce(root)}; });
}

Read<Status> read_status(std::string_view json) {
  return read<Status>(json,
                      {"team_interface", "command_post_interface", "kept", "endpoints", "pending", "last",
                       "last_nonce", "why"},
                      [](const Field& root) {
                        return Status{.team_interface = text(root, "team_interface"),
                                      .command_post_interface = text(root, "command_post_interface"),
                                      .kept = kept(root),
                                      .endpoints = endpoints(root),
                                      .pending = pending(root),
                                      .ended = ended(root),
                                      .ended_nonce = text(root, "last_nonce"),
                                      .why = text(root, "why")};
                      });
}

Read<Probed> read_probed(std::string_view json) {
  return read<Probed>(json, {"nonce", "address", "claimant", "own", "found_on", "trouble"},
                      [](const Field& root) {
                        return Probed{.nonce = nonce(root),
                                      .address = text(root, "address"),
                                      .claimant = text(root, "claimant"),
                                      .own = text(root, "own"),
                                      .found_on = text(root, "found_on"),
                                      .trouble = text(root, "trouble")};
                      });
}

std::string write_kept(const Numbers& numbers) {
  return written({{"numbers", to_json(numbers)}});
}

Read<Numbers> read_kept(std::string_view json) {
  return read<Numbers>(json, {"numbers"}, [](const Field& root) { return numbers(root, "numbers"); });
}

}  // namespace adit::network
