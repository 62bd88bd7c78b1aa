#include "update/messages.hpp"

#include "codec/nonce.hpp"

namespace adit::update {

static constexpr std::string_view kWhatWords[] = {"install", "stick", "restart", "back",
                                                  "stay"};  // in the order of Request::What
static constexpr auto& words_of(Request::What /*of*/) {
  return kWhatWords;
}

namespace {

using codec::member;
using codec::Member;
using codec::Row;

constexpr Member kRequestMembers[] = {
    member<&Request::nonce>("nonce").as(codec::kNonce),
    member<&Request::what>("what"),
    member<&Request::again>("again"),
};
constexpr Member kRunningMembers[] = {
    member<&Running::compatible>("compatible"),
    member<&Running::version>("version"),
    member<&Running::slot>("slot"),
    member<&Running::other>("other"),
};
constexpr Member kOfferMembers[] = {
    member<&Offer::name>("name"),
    member<&Offer::version>("version"),
};
constexpr Member kLastUpdateMembers[] = {
    member<&LastUpdate::stage>("stage"), member<&LastUpdate::version>("version"),
    member<&LastUpdate::slot>("slot"),   member<&LastUpdate::boot>("boot"),
    member<&LastUpdate::why>("why"),
};
constexpr Member kProvenMembers[] = {
    member<&Proven::slot>("slot"),
    member<&Proven::version>("version"),
};
constexpr Member kStatusMembers[] = {
    member<&Status::trouble>("trouble"),
    member<&Status::running>("running"),
    member<&Status::nonce>("nonce"),
    member<&Status::refusal>("refusal"),
    member<&Status::doing>("doing"),
    member<&Status::progress>("progress").from(0).to(100),
    member<&Status::last>("last"),
    member<&Status::trial>("trial"),
    member<&Status::stray>("stray"),
    member<&Status::stick>("stick"),
    member<&Status::stick_trouble>("stick_trouble"),
};

}  // namespace

constexpr Row Request::kRow = {"", kRequestMembers};
constexpr Row Running::kRow = {"", kRunningMembers};
constexpr Row Offer::kRow = {"", kOfferMembers};
constexpr Row LastUpdate::kRow = {"", kLastUpdateMembers};
constexpr Row Proven::kRow = {"", kProvenMembers};
constexpr Row Status::kRow = {"", kStatusMembers};

}  // namespace adit::update
