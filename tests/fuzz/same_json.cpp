// JSON as Adit reads it and as an independent strict reader does, nlohmann's. README.md says where they
// differ on purpose.
#include "codec/body_decoder.hpp"
#include "codec/json.hpp"
#include "same_value.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

/// Deeper than Adit takes it. Of well-formed JSON.
bool is_deep(Input text) {
  int depth = 0, deepest = 0;
  bool in_string = false;
  for (std::size_t at = 0; at < text.size(); ++at) {
    if (text[at] == '"') in_string = !in_string;
    if (in_string && text[at] == '\\') ++at;
    if (in_string) continue;
    if (text[at] == '[' || text[at] == '{') deepest = std::max(deepest, ++depth);
    if (text[at] == ']' || text[at] == '}') --depth;
  }
  return deepest > codec::BodyDecoder::kDeepest;
}

}  // namespace

void try_same_json(Input text) {
  const auto ours = codec::parse_json(text);
  require(ours || !ours.error().empty());
  if (text.contains('\0')) return require(!ours);  // which ends the document for nlohmann
  const auto theirs = nlohmann::json::parse(text, nullptr, false);
  if (ours) {
    require(theirs.is_discarded() ? has_infinity(*ours) : is_same(*ours, theirs));
  } else {
    require(theirs.is_discarded() || is_deep(text));
  }
}

}  // namespace adit::fuzz
