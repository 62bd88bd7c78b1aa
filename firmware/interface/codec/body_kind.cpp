// Reads the form of a body from its headers.
#include "codec/body_decoder.hpp"
#include "icd/letter_case.hpp"
#include "icd/text.hpp"

namespace adit::codec {
namespace {

constexpr std::string_view kBlanks = " \t";  // RFC 9110 5.6.3

}  // namespace

std::optional<Format> format_of(std::string_view content_type) {
  const std::string_view type = icd::trimmed(content_type.substr(0, content_type.find(';')), kBlanks);
  if (icd::same_but_for_case(type, "application/json")) return Format::Json;
  if (icd::same_but_for_case(type, "application/cbor")) return Format::Cbor;
  return std::nullopt;
}

std::optional<ContentCoding> coding_of(std::string_view content_encoding) {
  const std::string_view coding = icd::trimmed(content_encoding, kBlanks);
  if (coding.empty() || icd::same_but_for_case(coding, "identity")) return ContentCoding::Identity;
  if (icd::same_but_for_case(coding, "gzip") || icd::same_but_for_case(coding, "x-gzip"))
    return ContentCoding::Gzip;
  if (icd::same_but_for_case(coding, "deflate")) return ContentCoding::Deflate;
  return std::nullopt;
}

}  // namespace adit::codec
