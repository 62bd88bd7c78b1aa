#include "body.hpp"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "codec/json.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "icd/rules.hpp"

namespace adit::fuzz {
namespace {

constexpr codec::Limits kLimits{.text_bytes = 1 << 16, .data_bytes = 1 << 16};

void require(bool law) {
  if (!law) std::abort();
}

/// How to read the body.
struct Choice {
  codec::BodyKind kind;
  codec::Split split = codec::Split::Nothing;
  std::size_t chunk = 1;
  int message = 0;
};

Choice choice_of(codec::Format format, std::uint8_t how, std::uint8_t chunk) {
  using codec::ContentCoding;
  const ContentCoding codings[] = {ContentCoding::Identity, ContentCoding::Identity, ContentCoding::Gzip,
                                   ContentCoding::Deflate};
  return {.kind = {format, codings[how & 3U]},
          .split = (how & 4U) == 0 ? codec::Split::MapData : codec::Split::Nothing,
          .chunk = 1U + chunk % 32U,
          .message = how >> 3U & 3};
}

icd::Checked<codec::Document> decode_in_chunks(const Choice& choice, std::span<const std::uint8_t> body) {
  codec::BodyDecoder decoder(choice.kind, choice.split, kLimits);
  while (!body.empty()) {
    const auto chunk = body.first(std::min(choice.chunk, body.size()));
    if (const auto fed = decoder.feed(chunk); !fed) return std::unexpected(fed.error());
    body = body.subspan(chunk.size());
  }
  return decoder.finish();
}

void require_same(const icd::Checked<codec::Document>& whole, const icd::Checked<codec::Document>& cut) {
  require(whole.has_value() == cut.has_value());
  if (!whole) {
    require(!whole.error().sentence.empty());
    // Which limit a compressed body meets first hangs on its pieces; every other verdict does not.
    if (whole.error().status != icd::Status::ContentTooLarge) require(whole.error() == cut.error());
    return;
  }
  require(whole->data == cut->data);
  require(whole->data_form == cut->data_form);
  require(codec::write_json(whole->root) == codec::write_json(cut->root));
}

/// What is read from JSON, written and read again stays as it is. (CBOR has more than JSON: integers over
/// 2^53, NaN and U+FFFF change, once, on the way into JSON.)
void require_settles(const codec::Value& value) {
  const auto once = codec::parse_json(codec::write_json(value));
  require(once.has_value());
  const std::string written = codec::write_json(*once);
  const auto twice = codec::parse_json(written);
  require(twice.has_value() && codec::write_json(*twice) == written);
}

/// What the service takes of a state or of markers, part by part, and what the strict reader takes are the
/// same where nothing is refused; where something is, each refusal has its sentence. What is taken can be
/// written.
template <class Message, class Write>
void require_parts(const icd::Checked<codec::InParts<Message>>& parts, const icd::Checked<Message>& whole,
                   Write write) {
  const bool all_good = parts && parts->refused.count == 0;
  require(whole.has_value() == all_good);
  if (!parts) {
    require(!parts.error().sentence.empty());
    return;
  }
  if (all_good) require(parts->message == *whole);
  const codec::RefusedParts& refused = parts->refused;
  if (refused.count > 0) {
    require(refused.others > 0);
    require(refused.sentences.size() == std::min(refused.count, codec::RefusedParts::kMostToldOf));
    require(!refused.refusal().sentence.empty());
  }
  require(!write(parts->message).empty());
}

void read_message(int message, const codec::Document& document) {
  const icd::Rules rules;
  switch (message) {
    case 0:
      (void)codec::read_map_update(document, rules);
      break;
    case 1:
      require_parts(codec::read_state_parts(document, rules), codec::read_state_update(document, rules),
                    codec::write_state_update);
      break;
    case 2:
      require_parts(codec::read_markers_parts(document, rules), codec::read_markers_update(document, rules),
                    codec::write_markers_update);
      break;
    default:
      (void)codec::read_artifact_report(document, rules);
  }
}

}  // namespace

void try_body(codec::Format format, std::span<const std::uint8_t> input) {
  if (input.size() < 2) return;
  const auto body = input.first(input.size() - 2);
  const Choice choice = choice_of(format, input[input.size() - 1], input[input.size() - 2]);
  const std::string_view text(reinterpret_cast<const char*>(body.data()), body.size());

  const auto whole = codec::decode(choice.kind, choice.split, text, kLimits);
  require_same(whole, decode_in_chunks(choice, body));
  const bool plain_json =
      format == codec::Format::Json && choice.kind.coding == codec::ContentCoding::Identity;
  if (plain_json && choice.split == codec::Split::Nothing) require(codec::is_json(text) == whole.has_value());
  if (!whole) return;

  require_settles(whole->root);
  read_message(choice.message, *whole);
}

}  // namespace adit::fuzz
