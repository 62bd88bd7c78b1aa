#include "rehearsal/command_post/document.hpp"

#include <sodium/utils.h>
#include <zlib.h>

#include <array>
#include <charconv>
#include <cstddef>
#include <utility>
#include <vector>

namespace adit::rehearsal {

namespace {

constexpr std::size_t kDeepest = 64;
constexpr std::size_t kMostValues = 4'000'000;
constexpr std::size_t kLongestReason = 300;

/// Builds the document from nlohmann's events. Returning false stops the reader, which recurses for CBOR: the
/// limit on depth keeps a hostile body from the end of the stack.
class Builder : public nlohmann::json_sax<Json> {
 public:
  explicit Builder(bool check_utf8) : check_utf8_(check_utf8) {}

  bool null() override { return put(nullptr) != nullptr; }
  bool boolean(bool value) override { return put(value) != nullptr; }
  bool number_integer(number_integer_t value) override { return put(value) != nullptr; }
  bool number_unsigned(number_unsigned_t value) override { return put(value) != nullptr; }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return put(value) != nullptr; }
  bool string(string_t& value) override { return utf8(value) && put(std::move(value)) != nullptr; }
  bool binary(binary_t& value) override { return put(Json::binary(std::move(value))) != nullptr; }
  bool start_object(std::size_t /*size*/) override { return open(Json::object()); }
  bool start_array(std::size_t /*size*/) override { return open(Json::array()); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(string_t& name) override {
    if (!utf8(name)) return false;
    if (!document.repeated && open_.back()->contains(name)) document.repeated = name;
    key_ = std::move(name);
    return true;
  }

  bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                   const nlohmann::detail::exception& error) override {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::string_view what = error.what();
    const auto end_of_id = what.find("] ");
    return fail(std::string(what.substr(end_of_id == std::string_view::npos ? 0 : end_of_id + 2)));
  }

  Document document;
  std::string reason;

 private:
  bool fail(const std::string& why) {
    if (reason.empty()) reason = why.substr(0, kLongestReason);
    return false;
  }

  /// nlohmann checks the UTF-8 of JSON while it reads, that of CBOR only when it writes.
  bool utf8(const std::string& text) {
    if (!check_utf8_) return true;
    try {
      static_cast<void>(Json(text).dump());
      return true;
    } catch (const Json::type_error&) {
      return fail("a text string that is not UTF-8");
    }
  }

  Json* put(Json value) {
    if (++values_ > kMostValues) {
      fail("more than 4000000 values");
      return nullptr;
    }
    if (open_.empty()) {
      document.value = std::move(value);
      return &document.value;
    }
    Json& parent = *open_.back();
    if (parent.is_array()) {
      parent.push_back(std::move(value));
      return &parent.back();
    }
    Json& member = parent[key_];
    member = std::move(value);
    return &member;
  }

  bool open(Json container) {
    if (open_.size() == kDeepest) return fail("nested deeper than 64");
    Json* const place = put(std::move(container));
    if (place != nullptr) open_.push_back(place);  // stays put: its parent does not grow while it is open
    return place != nullptr;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  bool check_utf8_;
  std::vector<Json*> open_;
  std::string key_;
  std::size_t values_ = 0;
};

}  // namespace

std::string text_of(double number) {
  std::array<char, 32> digits;
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  return {digits.data(), end};
}

std::expected<Document, std::string> read_document(std::string_view body, Format format) {
  if (format == Format::JsonText && body.starts_with("\xef\xbb\xbf")) {
    return std::unexpected("a byte order mark before the document (RFC 8259 8.1)");
  }
  // To nlohmann's reader a NUL is the end of the document; to RFC 8259 it stands nowhere in one.
  if (format == Format::JsonText && body.find('\0') != std::string_view::npos) {
    return std::unexpected("a NUL byte");
  }
  Builder builder(format == Format::CborBytes);
  const auto input = format == Format::CborBytes ? Json::input_format_t::cbor : Json::input_format_t::json;
  if (!Json::sax_parse(body.begin(), body.end(), &builder, input, true)) {
    return std::unexpected(builder.reason.empty() ? "not well-formed" : builder.reason);
  }
  return std::move(builder.document);
}

std::optional<std::string> base64_decoded(std::string_view text) {
  std::string bytes(text.size() / 4 * 3, '\0');
  std::size_t size = 0;
  const int wrong =
      sodium_base642bin(reinterpret_cast<unsigned char*>(bytes.data()), bytes.size(), text.data(),
                        text.size(), nullptr, &size, nullptr, sodium_base64_VARIANT_ORIGINAL);
  if (wrong != 0) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

namespace {

constexpr int kGzip = 15 + 16;
constexpr int kZlib = 15;
constexpr int kBare = -15;
constexpr std::size_t kInflatedPiece = std::size_t{256} << 10;

/// `window` as inflateInit2 takes it. Bodies are below 4 GiB, so that zlib's counters hold them.
std::expected<std::string, InflateFault> inflate_one(std::string_view bytes, int window, std::size_t most) {
  z_stream stream{};
  if (inflateInit2(&stream, window) != Z_OK) return std::unexpected(InflateFault::Broken);
  // zlib does not write through next_in; its type is from before const.
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  stream.avail_in = static_cast<uInt>(bytes.size());
  std::vector<char> piece(kInflatedPiece);
  std::string out;
  int state = Z_OK;
  while (state == Z_OK && out.size() <= most) {
    stream.next_out = reinterpret_cast<Bytef*>(piece.data());
    stream.avail_out = static_cast<uInt>(piece.size());
    state = inflate(&stream, Z_NO_FLUSH);
    out.append(piece.data(), piece.size() - stream.avail_out);
  }
  const bool followed = stream.avail_in > 0;
  inflateEnd(&stream);
  if (out.size() > most) return std::unexpected(InflateFault::TooLarge);
  if (state != Z_STREAM_END) return std::unexpected(InflateFault::Broken);
  if (followed) return std::unexpected(InflateFault::Followed);
  return out;
}

}  // namespace

std::expected<std::string, InflateFault> gunzip(std::string_view bytes, std::size_t most) {
  return inflate_one(bytes, kGzip, most);
}

std::expected<std::string, InflateFault> inflate_body(std::string_view bytes, std::size_t most) {
  auto inflated = inflate_one(bytes, kZlib, most);
  return inflated ? inflated : inflate_one(bytes, kBare, most);
}

}  // namespace adit::rehearsal
