#include "api/settings_rows.hpp"

#include <utility>

namespace adit::api {
namespace {

using codec::member;
using codec::Member;
using codec::Row;
using codec::RowKind;
using codec::Schema;
using codec::Value;

constexpr Schema kSettingsSchema = {
    .type = "object",
    .more = R"("description":"The settings file: firmware/rules/settings/README.md.",)"
            R"("properties":{"version":{"const":1}},"required":["version"])",
    .name = "Settings"};
constexpr RowKind kSettings = {
    .write = codec::kind_of<Value>.write, .read = codec::kind_of<Value>.read, .schema = &kSettingsSchema};

/// A whole or a real number, by key.
constexpr RowKind kNumber = {.write = codec::kind_of<Value>.write,
                             .read = codec::kind_of<Value>.read,
                             .schema = &codec::KindOf<double>::schema};

constexpr std::string_view kKeyKinds[] = {"flag", "whole", "real", "text", "choice", "version"};

constexpr Member kFault[] = {member<&settings::Error::path>("path"), member<&settings::Error::what>("what")};
constexpr Row kFaultRow = {"Fault", kFault};

constexpr Member kChange[] = {
    member<&settings::Change::path>("path"),
    member<&settings::Change::from>("from", "null if absent"),
    member<&settings::Change::to>("to", "null if absent"),
};
constexpr Row kChangeRow = {"Change", kChange};

}  // namespace
}  // namespace adit::api

namespace adit::codec {

template <>
struct KindOf<settings::Error> : KindOfRow<settings::Error, api::kFaultRow> {};
template <>
struct KindOf<settings::Change> : KindOfRow<settings::Change, api::kChangeRow> {};

/// An object with a member for each token.
template <>
struct KindOf<std::vector<api::TokenRow>> {
  static Value write(const std::vector<api::TokenRow>& tokens) {
    Value::Object object;
    for (const api::TokenRow& token : tokens) object.emplace_back(token.name, Value{token.set});
    return {std::move(object)};
  }
  static void read(const Field& field, std::vector<api::TokenRow>& tokens) {
    if (!field.is<Value::Object>()) return field.refuse_kind("an object");
    for (const auto& [name, set] : std::get<Value::Object>(field.value()->is)) {
      const Field token = field.member(name);
      tokens.push_back({.name = name, .set = token.truth()});
    }
  }
  static constexpr Schema schema = {.type = "object", .more = R"("additionalProperties":{"type":"boolean"})"};
};

}  // namespace adit::codec

namespace adit::api {
namespace {

constexpr Member kKey[] = {
    member<&KeyRow::path>("path"),
    member<&KeyRow::meaning>("meaning"),
    member<&KeyRow::kind>("kind").one_of(kKeyKinds),
    member<&KeyRow::required>("required"),
    member<&KeyRow::default_value>("default"),
    member<&KeyRow::range>("range", "range of the value in words"),
    member<&KeyRow::words>("words").optional(),
    member<&KeyRow::least>("least").as(kNumber).optional(),
    member<&KeyRow::most>("most").as(kNumber).optional(),
};

constexpr Member kSetup[] = {
    member<&SetupView::settings>("settings").as(kSettings),
    member<&SetupView::tag>("tag", "identifies this version of the settings"),
    member<&SetupView::saved>("saved",
                              "whether the settings were saved here; false for the initial settings"),
    member<&SetupView::applying>("applying", "whether a change is being applied, within a second"),
    member<&SetupView::trouble>("trouble", "why the last change was reverted, or empty"),
    member<&SetupView::tokens>("tokens", "all possible tokens, and whether each is set"),
    member<&SetupView::odd_tokens>("odd_tokens", "warnings about tokens that are set, by name"),
    member<&SetupView::keys>("keys"),
};

constexpr Member kChanged[] = {
    member<&ChangesView::changes>("changes"),
    member<&ChangesView::warnings>(
        "warnings", "effects of the changes, also on reports that are queued, held or in doubt"),
};

constexpr Member kCheck[] = {
    member<&CheckView::errors>("errors"),
    member<&CheckView::changes>(""),
};

}  // namespace

constexpr Row kKeyRow = {"", kKey};
constexpr Row SetupView::kRow = codec::complete<SetupView>({"Setup", kSetup});
constexpr Row ChangesView::kRow = codec::complete<ChangesView>({"Changes", kChanged});
constexpr Row CheckView::kRow = codec::complete<CheckView>({"Checked", kCheck});

SetupView setup_view(const Setup& setup) {
  SetupView view{.settings = settings::value_of(setup.settings()),
                 .tag = settings::tag_of(setup.settings()),
                 .saved = setup.is_saved(),
                 .applying = setup.applying(),
                 .trouble = setup.trouble(),
                 .tokens = setup.tokens()};
  for (const TokenRow& token : view.tokens) {
    if (!token.warning.empty()) view.odd_tokens.push_back({token.name, token.warning});
  }
  view.keys = settings::keys();
  return view;
}

}  // namespace adit::api
