#include "forward/upstream_answer.hpp"

#include "codec/json.hpp"
#include "codec/write.hpp"
#include "dispatch/said.hpp"
#include "intake/icd_routes.hpp"

namespace adit::forward {
intake::Answer client_answer(const uplink::Answered& answered) {
  const auto status = static_cast<icd::Status>(answered.status);
  if (codec::is_json(answered.body)) {
    return {
        .status = status, .content_type = std::string(codec::kJson), .body = answered.body, .headers = {}};
  }
  const std::string sentence =
      dispatch::answered_with(answered.status) +
      (answered.body.empty() ? " with an empty body" : " with something other than JSON");
  return intake::error_answer(answered.status < 400 ? icd::Status::BadGateway : status, sentence);
}

}  // namespace adit::forward
