#include "gateway/upstream_answer.hpp"

#include "codec/json.hpp"
#include "codec/write.hpp"
#include "intake/icd_routes.hpp"

namespace adit::gateway {
namespace {

constexpr std::size_t kLongestSentence = 300;

std::string cut(std::string text) {
  if (text.size() <= kLongestSentence) return text;
  std::size_t end = kLongestSentence;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80)
    --end;  // not within a UTF-8 sequence
  text.resize(end);
  return text + "...";
}

std::string without_sentence(int status) {
  return "the Command Post answered " + std::to_string(status);
}

}  // namespace

intake::Answer client_answer(const uplink::Answered& answered) {
  const auto status = static_cast<icd::Status>(answered.status);
  if (codec::is_json(answered.body)) {
    return {
        .status = status, .content_type = std::string(codec::kJson), .body = answered.body, .headers = {}};
  }
  const std::string sentence =
      without_sentence(answered.status) +
      (answered.body.empty() ? " with an empty body" : " with something other than JSON");
  return intake::error_answer(answered.status < 400 ? icd::Status::BadGateway : status, sentence);
}

std::string sentence_of(const uplink::Answered& answered) {
  const auto value = codec::parse_json(answered.body);
  if (!value) return without_sentence(answered.status);
  if (const auto* text = std::get_if<std::string>(&value->is)) return cut(*text);
  if (const auto* object = std::get_if<codec::Value::Object>(&value->is)) {
    for (const auto& [name, member] : *object) {
      const auto* detail = std::get_if<std::string>(&member.is);
      if (name == "detail" && detail != nullptr) return cut(*detail);
    }
  }
  return without_sentence(answered.status);
}

}  // namespace adit::gateway
