#include "spare/stick.hpp"

#include "network/messages.hpp"
#include "spare/file_name.hpp"

namespace adit::spare {
namespace {

constexpr std::string_view kWhatWords[] = {"write", "take"};  // in the order of StickRequest::What

/// A name that cannot lead out of a folder.
void read_file_name(const codec::Field& field, void* name) {
  auto& text = *static_cast<std::string*>(name);
  text = field.text();
  if (!is_file_name(text)) field.refuse("expected the name of an export");
}
constexpr codec::Kind kFileName = {.write = codec::kind_of<std::string>.write,
                                   .read = read_file_name,
                                   .schema = codec::kind_of<std::string>.schema};

}  // namespace
}  // namespace adit::spare

namespace adit::codec {

template <>
struct KindOf<spare::StickRequest::What> : KindOfWords<spare::StickRequest::What, spare::kWhatWords> {};

}  // namespace adit::codec

namespace adit::spare {
namespace {

using codec::member;

constexpr codec::Member kRequestMembers[] = {
    member<&StickRequest::nonce>("nonce").as(network::kNonce),
    member<&StickRequest::what>("what"),
    member<&StickRequest::name>("name").as(kFileName),
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
