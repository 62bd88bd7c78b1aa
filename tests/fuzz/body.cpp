// A request's body, whole and in pieces, plain and compressed, and the message in it.
#include <algorithm>

#include "codec/body_decoder.hpp"
#include "codec/json.hpp"
#include "codec/read.hpp"
#include "codec/write.hpp"
#include "icd/rules.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

constexpr codec::Limits kLimits{.text_bytes = 1 << 16, .data_bytes = 1 << 16};

/// How to read the body.
struct Choice {
  codec::BodyKind kind;
  codec::Split split = codec::Split::Nothing;
  std::size_t piece = 1;
  int message = 0;
};

Choice choice_of(codec::Format format, std::uint8_t how, std::size_t piece) {
  using codec::ContentCoding;
  const ContentCoding codings[] = {ContentCoding::Identity, ContentCoding::Identity, ContentCoding::Gzip,
                                   ContentCoding::Deflate};
  return {.kind = {format, codings[how & 3U]},
          .split = (how & 4U) == 0 ? codec::Split::MapData : codec::Split::Nothing,
          .piece = piece,
          .message = how >> 3U & 3};
}

icd::Checked<codec::Document> decode_in_pieces(const Choice& choice, Input body) {
  codec::BodyDecoder decoder(choice.kind, choice.split, kLimits);
  icd::Checked<void> fed;
  in_pieces(body, choice.piece, [&](Input each) { return (fed = decoder.feed(bytes_of(each))).has_value(); });
  if (!fed) return std::unexpected(fed.error());
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
  require(whole->pressed.has_value() == cut->pressed.has_value());
  if (whole->pressed) {
    require(whole->pressed->count == cut->pressed->count && whole->pressed->checked == cut->pressed->checked);
  }
  require(codec::write_json(whole->root) == codec::write_json(cut->root));
}

/// Its arrays left as text, it is the same document, and has the same markers.
void require_same_in_lists(const Choice& choice, Input body, const codec::Document& whole) {
  if (choice.split != codec::Split::Nothing) return;
  const auto listed = codec::decode(choice.kind, codec::Split::Lists, body, kLimits);
  if (!listed) return require(listed.error().status == icd::Status::ContentTooLarge);
  require(codec::write_json(listed->root) == codec::write_json(whole.root));
  const auto ours = codec::read_markers_parts(*listed, {}), others = codec::read_markers_parts(whole, {});
  require(ours.has_value() == others.has_value());
  if (!ours) return require(ours.error() == others.error());
  require(ours->message == others->message && ours->refused.sentences == others->refused.sentences);
}

/// What is read from JSON, written and read again stays as it is. (CBOR has more than JSON: integers over
/// 2^53 and NaN change, once, on the way into JSON.)
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
void require_parts(const icd::Checked<codec::CheckedParts<Message>>& parts,
                   const icd::Checked<Message>& whole, Write write) {
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

/// What goes upstream says the same.
template <class Message>
void require_written(const icd::Checked<Message>& message, codec::Format format, codec::Split split,
                     const auto& write, const auto& read) {
  if (!message) return require(!message.error().sentence.empty());
  const auto document = codec::decode({.format = format}, split, write(*message));
  require(document.has_value());
  require(read(*document, icd::Rules()) == message);
}

std::string written_map(const icd::MapUpdate& map) {
  return codec::write_map_update(map).to_string();
}
std::string written_state(const icd::StateUpdate& state) {
  return codec::write_state_update(state).to_string();
}
std::string written_markers(const icd::MarkersUpdate& markers) {
  return codec::write_markers_update(markers).to_string();
}

icd::Checked<icd::ArtifactReport> read_report(const codec::Document& document, const icd::Rules& rules) {
  auto read = codec::read_artifact_report(document, rules);
  if (!read) return std::unexpected(std::move(read.error()));
  return std::move(read->report);
}

void read_message(int message, const codec::Document& document) {
  using enum codec::Format;
  using enum codec::Split;
  const icd::Rules rules;
  switch (message) {
    case 0:
      require_written(codec::read_map_update(document, rules), Cbor, MapData, written_map,
                      codec::read_map_update);
      break;
    case 1:
      require_parts(codec::read_state_parts(document, rules), codec::read_state_update(document, rules),
                    codec::write_state_update);
      require_written(codec::read_state_update(document, rules), Cbor, Nothing, written_state,
                      codec::read_state_update);
      break;
    case 2:
      require_parts(codec::read_markers_parts(document, rules), codec::read_markers_update(document, rules),
                    codec::write_markers_update);
      require_written(codec::read_markers_update(document, rules), Cbor, Nothing, written_markers,
                      codec::read_markers_update);
      break;
    default:
      require_written(read_report(document, rules), Json, Nothing, codec::write_artifact_report, read_report);
  }
}

/// Behind the body are two bytes that say how it is read.
void try_body(codec::Format format, Input body) {
  if (body.size() < 2) return;
  const auto how = static_cast<std::uint8_t>(body.back());
  body.remove_suffix(1);
  const Choice choice = choice_of(format, how, take_piece(body));

  const auto whole = codec::decode(choice.kind, choice.split, body, kLimits);
  require_same(whole, decode_in_pieces(choice, body));
  const bool plain_json =
      format == codec::Format::Json && choice.kind.coding == codec::ContentCoding::Identity;
  if (plain_json && choice.split == codec::Split::Nothing)
    require(codec::parse_json(body).has_value() == whole.has_value());
  if (!whole) return;

  require_settles(whole->root);
  require_same_in_lists(choice, body, *whole);
  read_message(choice.message, *whole);
}

}  // namespace

void try_json(Input body) {
  try_body(codec::Format::Json, body);
}

void try_cbor(Input body) {
  try_body(codec::Format::Cbor, body);
}

}  // namespace adit::fuzz
