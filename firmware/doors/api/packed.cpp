#include "api/packed.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>

#include "codec/gzip_whole.hpp"
#include "icd/letter_case.hpp"
#include "icd/text.hpp"

namespace adit::api {
namespace {

constexpr std::size_t kFewest = 1400;  // a smaller body fits one packet anyway
constexpr std::size_t kMost = 1u << 20;

/// Removes and returns the trimmed text before the next `mark`; `text` becomes the rest.
std::string_view take(std::string_view& text, char mark) {
  return icd::trimmed(icd::cut(text, mark), " \t");
}

/// "q=0", "q=0.0": not acceptable.
bool is_forbidden(std::string_view weight) {
  if (!weight.starts_with("q=") && !weight.starts_with("Q=")) return false;
  return weight.substr(2).find_first_not_of("0.") == std::string_view::npos;
}

bool has_header(const intake::Answer& answer, std::string_view name) {
  return std::ranges::find(answer.headers, name, &intake::Header::name) != answer.headers.end();
}

bool pays(const intake::Answer& answer) {
  const std::string_view type = answer.content_type;
  const bool is_text = type.starts_with("text/") || type.starts_with("application/json");
  return is_text && answer.body.size() >= kFewest && answer.body.size() <= kMost && !is_packed(answer) &&
         !has_header(answer, "ETag");
}

}  // namespace

bool takes_gzip(std::string_view accept_encoding) {
  bool any = false;
  while (!accept_encoding.empty()) {
    auto coding = take(accept_encoding, ',');
    const auto name = take(coding, ';');
    const bool taken = !is_forbidden(icd::trimmed(coding, " \t"));
    if (icd::same_but_for_case(name, "gzip") || icd::same_but_for_case(name, "x-gzip")) return taken;
    if (name == "*") any = taken;
  }
  return any;
}

bool is_packed(const intake::Answer& answer) {
  return has_header(answer, "Content-Encoding");
}

void pack_if_it_pays(intake::Answer& answer) {
  if (!pays(answer)) return;
  answer.headers.push_back({"Vary", "Accept-Encoding"});
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(answer.body.data()), answer.body.size());
  const auto member = codec::gzip_whole(bytes, codec::kFastestLevel, bytes.size());
  if (!member) return;  // it would be longer
  answer.body = member->to_string();
  answer.headers.push_back({"Content-Encoding", "gzip"});
}

}  // namespace adit::api
