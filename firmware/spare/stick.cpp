#include "spare/stick.hpp"

#include "codec/nonce.hpp"
#include "spare/file_name.hpp"

namespace adit::spare {

static constexpr std::string_view kWhatWords[] = {"write", "take"};  // in the order of StickRequest::What
static constexpr auto& words_of(StickRequest::What /*of*/) {
  return kWhatWords;
}

namespace {

using codec::member;

/// A name that cannot leave its directory.
constexpr char kExpectedName[] = "expected the name of an export";

constexpr codec::Member kRequestMembers[] = {
    member<&StickRequest::nonce>("nonce").as(codec::kNonce),
    member<&StickRequest::what>("what"),
    member<&StickRequest::name>("name").as(codec::kCheckedText<is_file_name, kExpectedName>),
};
constexpr codec::Member kStatusMembers[] = {
    member<&StickStatus::nonce>("nonce"),         member<&StickStatus::refusal>("refusal"),
    member<&StickStatus::doing>("doing"),         member<&StickStatus::written>("written"),
    member<&StickStatus::hindrance>("hindrance"), member<&StickStatus::exports>("exports"),
};

}  // namespace

constexpr codec::Row StickRequest::kRow = {"", kRequestMembers};
constexpr codec::Row StickStatus::kRow = {"", kStatusMembers};

}  // namespace adit::spare
