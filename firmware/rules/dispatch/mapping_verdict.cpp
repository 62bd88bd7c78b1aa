#include "dispatch/mapping_verdict.hpp"

#include <algorithm>

#include "codec/json.hpp"
#include "icd/success.hpp"

namespace adit::dispatch {
namespace {

constexpr int kThrottled = 429;
/// A handler of the Command Post failed at a message. Proxies send other 5xx.
constexpr int kHandlerFailed = 500;

}  // namespace

Body body_of(std::string_view body) {
  constexpr std::string_view kSpace = " \t\r\n";
  if (body.find_first_not_of(kSpace) == std::string_view::npos) return Body::Empty;
  return codec::parse_json(body) ? Body::Json : Body::Other;
}

bool may_be_the_command_post(int status, Body body) {
  if (status >= 300 && status < 400) return false;
  return body != Body::Other || status == 404 || status == 429 || status >= 500;
}

bool is_the_command_post(int status, Body body) {
  return icd::is_success(status) && body == Body::Json;
}

MappingVerdict mapping_verdict(int status, Body body) {
  if (icd::is_success(status)) return body == Body::Other ? MappingVerdict::Failing : MappingVerdict::Taken;
  if (status == kThrottled) return MappingVerdict::Throttled;
  if (status == kTooLarge) return MappingVerdict::TooLarge;
  if (status == 409 || status == 415 || status == kHandlerFailed) return MappingVerdict::Suspect;
  if (status == 400 || status == 422) {
    return body == Body::Other ? MappingVerdict::Suspect : MappingVerdict::Refused;
  }
  return MappingVerdict::Failing;
}

bool may_concern_a_part(int status) {
  return status >= 300 && status != kThrottled;
}

}  // namespace adit::dispatch
