#include "api/keys.hpp"

namespace adit::codec {

template <>
struct KindOf<access::Role> : WriteOnly {
  static Value write(access::Role role) { return {std::string(name_of(role))}; }
  static constexpr Schema schema = {
      .type = "string", .more = R"("enum":["operator","viewer"])", .name = "Role"};
};

}  // namespace adit::codec

namespace adit::api {
namespace {

using codec::member;
using codec::Member;

constexpr Member kSession[] = {
    member<&SessionRow::number>("number"),
    member<&SessionRow::role>("role"),
    member<&SessionRow::address>("address"),
    member<&SessionRow::agent>("agent", "User-Agent of the browser"),
    member<&SessionRow::made>("made", "seconds since 1970"),
    member<&SessionRow::seen>("seen", "seconds since 1970"),
    member<&SessionRow::own>("own", "whether this is the client's own session"),
};

constexpr Member kWhoAsks[] = {
    member<&SessionView::role>("role"),
    member<&SessionView::csrf>(
        "csrf", "value of the header Adit-CSRF for requests with the cookie; null without a session")
        .as(codec::kTextOrNull),
    member<&SessionView::first_start>("first_start",
                                      "whether no password is set yet, so that the code sets one"),
    member<&SessionView::set_up_open>("set_up_open",
                                      "whether the operator's password can be set without the present one, "
                                      "because the box's button opened set-up"),
};

}  // namespace

constexpr codec::Row SessionRow::kRow = {"Session", kSession};
constexpr codec::Row SessionView::kRow = {"SessionView", kWhoAsks};

}  // namespace adit::api
