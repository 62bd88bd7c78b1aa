#include "dispatch/answer_text.hpp"

#include "codec/json.hpp"
#include "dispatch/mapping_verdict.hpp"
#include "icd/sentence.hpp"

namespace adit::dispatch {
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

}  // namespace

std::string answered_with(int status) {
  return icd::sentence("the Command Post answered ", status);
}

std::string oversize_text(std::size_t bytes, std::string_view body) {
  constexpr std::size_t kKilobyte = 1000;
  return icd::sentence("too large (", (bytes + kKilobyte - 1) / kKilobyte,
                       " kB): ", answer_text(kTooLarge, body));
}

std::string answer_text(int status, std::string_view body) {
  const auto value = codec::parse_json(body);
  if (!value) return answered_with(status);
  if (const auto* text = std::get_if<std::string>(&value->is)) return cut(*text);
  if (const auto* object = std::get_if<codec::Value::Object>(&value->is)) {
    for (const auto& [name, member] : *object) {
      const auto* detail = std::get_if<std::string>(&member.is);
      if (name == "detail" && detail != nullptr) return cut(*detail);
    }
    if (status >= 400 && !object->empty())
      return cut(answered_with(status) + ": " + codec::write_json(*value));
  }
  return answered_with(status);
}

}  // namespace adit::dispatch
