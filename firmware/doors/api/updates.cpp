#include "api/updates.hpp"

namespace adit::api {
namespace {

using codec::member;
using codec::Member;
using codec::Row;
using update::LastUpdate;
using update::Status;

constexpr auto kStages = std::span(update::kStageWords).subspan(1);  // without the empty one
constexpr std::string_view kDoing[] = {"receiving", "checking", "installing", "restarting"};

constexpr Member kLastMembers[] = {
    member<&LastUpdate::stage>("stage").one_of(kStages),
    member<&LastUpdate::version>("version"),
    member<&LastUpdate::slot>("slot"),
    member<&LastUpdate::why>("why"),
};
constexpr Row kLast = {"", kLastMembers};

/// null without an update.
struct LastOrNull {
  static codec::Value write(const LastUpdate& last) {
    return last.stage == update::Stage::None ? codec::Value{} : write_row(kLast, &last);
  }
  static void read(const codec::Field& field, LastUpdate& last) {
    if (!field.is_absent()) read_row(kLast, field, &last);
  }
  static constexpr codec::Schema schema = {.row = &kLast, .or_null = true};
};

constexpr Member kUpdate[] = {
    member<&UpdateView::managed>("managed"),
    member<&UpdateView::why>("why", "why the box cannot be updated here"),
    member<&UpdateView::runs_here>("runs_here",
                                   "false: this machine has no adit-update, as a PC with its own updates"),
    member<&UpdateView::status, &Status::running, &update::Running::compatible>("board"),
    member<&UpdateView::status, &Status::running, &update::Running::version>("version"),
    member<&UpdateView::status, &Status::running, &update::Running::slot>("slot", "running slot"),
    member<&UpdateView::status, &Status::running, &update::Running::other>("other_slot",
                                                                           "slot for the next update"),
    member<&UpdateView::status, &Status::trial>(
        "trial", "whether the running version was installed last and has not yet been healthy for a minute"),
    member<&UpdateView::status, &Status::stray>("stray", "which unexpected slot is running, and why")
        .as(codec::kTextOrNull),
    member<&UpdateView::status, &Status::doing>("doing").as(codec::kTextOrNull).one_of(kDoing),
    member<&UpdateView::status, &Status::progress>("progress").from(0).to(100),
    member<&UpdateView::status, &Status::refusal>("refusal", "why the last update was not installed")
        .as(codec::kTextOrNull),
    member<&UpdateView::status, &Status::last>("last").as(codec::kind_as<LastUpdate, LastOrNull>),
    member<&UpdateView::status, &Status::stick>("stick"),
    member<&UpdateView::status, &Status::stick_trouble>("stick_why",
                                                        "why the update on a stick cannot be installed")
        .as(codec::kTextOrNull),
    member<&UpdateView::newer>(
        "newer", "newer version that apt has; empty: no newer one; null: not known, as without apt"),
    member<&UpdateView::newer_why>("newer_why", "why the newer version cannot be read")
        .as(codec::kTextOrNull),
};

}  // namespace

constexpr Row UpdateView::kRow = {"Update", kUpdate};

}  // namespace adit::api
