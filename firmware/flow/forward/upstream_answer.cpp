#include "forward/upstream_answer.hpp"

#include "codec/json.hpp"
#include "codec/write.hpp"
#include "dispatch/verdicts.hpp"
#include "intake/icd_routes.hpp"

namespace adit::forward {
intake::Answer client_answer(const uplink::Answered& answered) {
  const auto status = static_cast<icd::Status>(answered.status);
  if (const auto json = codec::parse_json(answered.body)) {
    const bool as_it_came = answered.status < 300 || std::holds_alternative<std::string>(json->is);
    if (!as_it_came)
      return intake::error_answer(status, dispatch::answer_text(answered.status, answered.body));
    return {
        .status = status, .content_type = std::string(codec::kJson), .body = answered.body, .headers = {}};
  }
  const std::string sentence =
      dispatch::answered_with(answered.status) +
      (answered.body.empty() ? " with an empty body" : " with a body that is not JSON");
  return intake::error_answer(answered.status < 400 ? icd::Status::BadGateway : status, sentence);
}

}  // namespace adit::forward
