// CBOR as Adit reads it, as RFC 8949's own appendix C has it well-formed, and its values as an independent
// reader has them, nlohmann's. README.md says where they differ on purpose.
#include "codec/body_decoder.hpp"
#include "same_value.hpp"
#include "target.hpp"

namespace adit::fuzz {
namespace {

/// RFC 8949 appendix C's well_formed(), and what Adit asks besides: text that is UTF-8, and little
/// nesting.
class WellFormed {
 public:
  explicit WellFormed(Input text) : left_(text) {}

  bool document() { return item(0) && left_.empty(); }
  bool taken_besides = true;

 private:
  enum : unsigned { kBytes = 2, kText = 3, kArray = 4, kMap = 5, kTag = 6, kSimple = 7, kIndefinite = 31 };

  bool take(std::size_t size, Input& taken) {
    taken = left_.substr(0, size);
    left_.remove_prefix(taken.size());
    return taken.size() == size;
  }

  bool number(unsigned info, std::uint64_t& value) {
    value = info;
    if (info < 24) return true;
    Input bytes;
    if (info > 27 || !take(std::size_t{1} << (info - 24), bytes)) return false;
    value = 0;
    for (const std::uint8_t byte : bytes_of(bytes)) value = value << 8U | byte;
    return true;
  }

  bool ended() {
    const bool is_break = left_.starts_with('\xff');
    if (is_break) left_.remove_prefix(1);
    return is_break;
  }

  bool item(int depth) {
    Input first;
    if (!take(1, first)) return false;
    const unsigned major = bytes_of(first)[0] >> 5U, info = bytes_of(first)[0] & 31U;
    if (info == kIndefinite) return indefinite(major, depth + 1);
    std::uint64_t value = 0;
    if (!number(info, value)) return false;
    if (major == kSimple) return info != 24 || value >= 32;
    if (major == kBytes || major == kText) return string(major, value);
    if (major < kBytes) return true;
    nest(depth + 1);
    const std::uint64_t items = major == kTag ? 1 : value;
    for (std::uint64_t i = 0; i < items; ++i) {
      if (!item(depth + 1) || (major == kMap && !item(depth + 1))) return false;
    }
    return true;
  }

  bool indefinite(unsigned major, int depth) {
    if (major == kArray || major == kMap) {
      nest(depth);
      while (!ended()) {
        if (!item(depth) || (major == kMap && !item(depth))) return false;
      }
      return true;
    }
    if (major != kBytes && major != kText) return false;
    while (!ended()) {
      Input first;
      std::uint64_t size = 0;
      if (!take(1, first) || bytes_of(first)[0] >> 5U != major) return false;
      if (!number(bytes_of(first)[0] & 31U, size) || !string(major, size)) return false;
    }
    return true;
  }

  bool string(unsigned major, std::uint64_t size) {
    Input text;
    if (!take(size, text)) return false;
    if (major == kText) {
      constexpr auto kReplace = nlohmann::json::error_handler_t::replace;
      const nlohmann::json written = std::string(text);
      const auto again = nlohmann::json::parse(written.dump(-1, ' ', false, kReplace));
      if (again != written) taken_besides = false;
    }
    return true;
  }

  void nest(int depth) {
    if (depth > codec::BodyDecoder::kDeepest) taken_besides = false;
  }

  Input left_;
};

}  // namespace

void try_same_cbor(Input text) {
  WellFormed rfc(text);
  const bool well_formed = rfc.document();
  const auto ours = codec::decode({.format = codec::Format::Cbor}, codec::Split::Nothing, text);
  require(ours.has_value() == (well_formed && rfc.taken_besides));
  if (!ours) return require(!ours.error().sentence.empty());
  using nlohmann::json;
  const json theirs = json::from_cbor(text, true, false, json::cbor_tag_handler_t::ignore);
  require(theirs.is_discarded() || is_same(ours->root, theirs));
}

}  // namespace adit::fuzz
