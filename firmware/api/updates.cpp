#include "api/updates.hpp"

#include <algorithm>

namespace adit::codec {

template <>
struct KindOf<update::Stage> {
  static Value write(update::Stage stage) { return {std::string(name_of(stage))}; }
  static void read(const Field& field, update::Stage& stage) {
    const auto* const word = std::ranges::find(update::kStageWords, field.text());
    if (word == std::end(update::kStageWords)) return field.refuse("expected a stage");
    stage = static_cast<update::Stage>(word - std::begin(update::kStageWords));
  }
  static constexpr Schema schema = KindOf<std::string>::schema;
};

}  // namespace adit::codec

namespace adit::api {
namespace {

using codec::member;
using codec::Member;
using codec::Row;
using update::LastUpdate;
using update::Offer;

constexpr auto kStages = std::span(update::kStageWords).subspan(1);  // but for none
constexpr std::string_view kDoing[] = {"receiving", "checking", "installing", "restarting"};

constexpr Member kOfferMembers[] = {member<&Offer::name>("name"), member<&Offer::version>("version")};
constexpr Row kOffer = {"", kOfferMembers};

constexpr Member kLastMembers[] = {
    member<&LastUpdate::stage>("stage").one_of(kStages),
    member<&LastUpdate::version>("version"),
    member<&LastUpdate::slot>("slot"),
    member<&LastUpdate::why>("why"),
};
constexpr Row kLast = {"", kLastMembers};

}  // namespace
}  // namespace adit::api

namespace adit::codec {

template <>
struct KindOf<update::Offer> : KindOfRow<update::Offer, api::kOffer> {};

/// null where there was none.
template <>
struct KindOf<update::LastUpdate> {
  static Value write(const update::LastUpdate& last) {
    return last.stage == update::Stage::None ? Value{} : write_row(api::kLast, &last);
  }
  static void read(const Field& field, update::LastUpdate& last) {
    if (!field.is_absent()) read_row(api::kLast, field, &last);
  }
  static constexpr Schema schema = {.row = &api::kLast, .or_null = true};
};

}  // namespace adit::codec

namespace adit::api {
namespace {

constexpr Member kUpdate[] = {
    member<&UpdateView::managed>("managed"),
    member<&UpdateView::why>("why", "why it cannot be updated here"),
    member<&UpdateView::running, &update::Running::compatible>("board"),
    member<&UpdateView::running, &update::Running::version>("version"),
    member<&UpdateView::running, &update::Running::slot>("slot"),
    member<&UpdateView::trial>("trial",
                               "what runs was installed last, and has not been healthy for a minute"),
    member<&UpdateView::doing>("doing").as(codec::kTextOrNull).one_of(kDoing),
    member<&UpdateView::progress>("progress").from(0).to(100),
    member<&UpdateView::refusal>("refusal", "why the last one was not installed").as(codec::kTextOrNull),
    member<&UpdateView::last>("last"),
    member<&UpdateView::stick>("stick"),
    member<&UpdateView::stick_why>("stick_why", "why what is on a stick cannot be installed")
        .as(codec::kTextOrNull),
};

}  // namespace

constexpr Row UpdateView::kRow = {"Update", kUpdate};

}  // namespace adit::api
