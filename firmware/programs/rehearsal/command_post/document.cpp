#include "rehearsal/command_post/document.hpp"

#include <sodium/utils.h>
#include <zlib.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

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

  bool null() override { return put(nullptr); }
  bool boolean(bool value) override { return put(value); }
  bool number_integer(number_integer_t value) override { return put(value); }
  bool number_unsigned(number_unsigned_t value) override { return put(value); }
  bool number_float(number_float_t value, const string_t& /*text*/) override { return put(value); }
  bool string(string_t& value) override { return utf8(value) && put(std::move(value)); }
  bool binary(binary_t& value) override { return put(Json::binary(std::move(value))); }
  bool start_object(std::size_t /*size*/) override { return put(Json::object(), true); }
  bool start_array(std::size_t /*size*/) override { return put(Json::array(), true); }
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

  bool put(Json value, bool opens = false) {
    if (++values_ > kMostValues) return fail("more than 4000000 values");
    if (opens && open_.size() == kDeepest) return fail("nested deeper than 64");
    Json* place = &document.value;
    if (!open_.empty()) {
      Json& parent = *open_.back();
      place = parent.is_array() ? &parent.emplace_back() : &parent[key_];
    }
    *place = std::move(value);
    if (opens) open_.push_back(place);  // stays put: its parent does not grow while it is open
    return true;
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

bool is_word_character(char c) {
  return icd::is_letter_or_digit(c) || c == '_';
}

std::optional<Rotation> read_quaternion(const Field& quaternion) {
  const auto x = quaternion.number("x"), y = quaternion.number("y"), z = quaternion.number("z"),
             w = quaternion.number("w");
  if (!x || !y || !z || !w) return std::nullopt;
  constexpr double kNoise = 2e-6;  // of float32, and of printed digits
  const double length = std::hypot(std::hypot(*x, *y, *z), *w);
  if (!(std::abs(length - 1) <= kNoise)) {
    quaternion.add_violation("expected a quaternion of length 1, got one of length " + std::to_string(length),
                             Measured::Takes);
  }
  return Rotation{*x, *y, *z, *w};
}

}  // namespace

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

std::expected<std::string, InflateFault> gunzip(std::string_view bytes, std::size_t most) {
  return inflate_one(bytes, kGzip, most);
}

std::expected<std::string, InflateFault> inflate_body(std::string_view bytes, std::size_t most) {
  auto inflated = inflate_one(bytes, kZlib, most);
  return inflated ? inflated : inflate_one(bytes, kBare, most);
}

std::string Field::path_of(std::string_view name) const {
  return path_.empty() ? std::string(name) : path_ + "." + std::string(name);
}

std::nullopt_t Field::add_violation(std::string_view what, Measured measured) const {
  const std::string where = path_.empty() ? "the body" : path_;
  findings_->add_violation(where + ": " + std::string(what), measured);
  return std::nullopt;
}

std::nullopt_t Field::report_mismatch(std::string_view what) const {
  const std::string got =
      value_->is_number() ? line_of(*value_) : std::string("a value of type ") + value_->type_name();
  return add_violation("expected " + std::string(what) + ", got " + got);
}

std::optional<Field> Field::optional_member(const char* name) const {
  if (!value_->is_object()) return std::nullopt;
  const auto found = value_->find(name);
  if (found == value_->end()) return std::nullopt;
  return Field(*found, path_of(name), *findings_);
}

std::optional<Field> Field::member(const char* name, Measured measured) const {
  if (!is_object()) return std::nullopt;
  auto found = optional_member(name);
  if (!found) findings_->add_violation("Missing field '" + path_of(name) + "'", measured);
  return found;
}

std::optional<std::vector<Field>> Field::elements() const {
  if (!value_->is_array()) return report_mismatch("an array");
  std::vector<Field> all;
  all.reserve(value_->size());
  for (const Json& element : *value_) {
    all.emplace_back(element, path_ + "[" + std::to_string(all.size()) + "]", *findings_);
  }
  return all;
}

bool Field::is_object() const {
  if (!value_->is_object()) report_mismatch("an object");
  return value_->is_object();
}

std::optional<double> Field::to_number() const {
  if (!value_->is_number()) return report_mismatch("a number");
  const auto number = value_->get<double>();
  if (!std::isfinite(number))
    return add_violation("expected a finite number");  // CBOR can say so, JSON cannot
  return number;
}

std::optional<std::int64_t> Field::integer(std::int64_t least, std::int64_t most) const {
  const bool fits = value_->is_number_integer() &&
                    !(value_->is_number_unsigned() && value_->get<std::uint64_t>() > INT64_MAX);
  const std::int64_t integer = fits ? value_->get<std::int64_t>() : 0;
  if (fits && integer >= least && integer <= most) return integer;
  return report_mismatch("an integer from " + std::to_string(least) + " to " + std::to_string(most));
}

std::optional<bool> Field::boolean() const {
  if (!value_->is_boolean()) return report_mismatch("a boolean");
  return value_->get<bool>();
}

std::optional<std::string> Field::to_text() const {
  if (!value_->is_string()) return report_mismatch("a text string");
  return value_->get<std::string>();
}

std::optional<std::int64_t> Field::integer(const char* name, std::int64_t least, std::int64_t most) const {
  const auto field = member(name);
  return field ? field->integer(least, most) : std::nullopt;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(), icd::lower);
  return text;
}

bool is_artifact_type(std::string_view type) {
  return std::ranges::any_of(
      kArtifactTypes, [type](std::string_view known) { return icd::equals_ignoring_case(known, type); });
}

std::string sanitize(std::string_view text) {
  constexpr std::size_t longest = 32;
  std::string tamed(text.substr(0, longest));
  std::ranges::replace_if(tamed, std::not_fn(is_word_character), '_');
  return tamed;
}

bool is_robot_name(std::string_view name) {
  return !name.empty() && name.size() <= 10 && std::ranges::all_of(name, is_word_character);
}

std::optional<Vector3> read_point(const Field& point) {
  const auto x = point.number("x"), y = point.number("y"), z = point.number("z");
  if (!x || !y || !z) return std::nullopt;
  return Vector3{*x, *y, *z};
}

std::optional<Placement> read_pose(const Field& pose) {
  const auto position = pose.member("position"), orientation = pose.member("orientation");
  if (!position || !orientation) return std::nullopt;
  const auto point = read_point(*position);
  const auto quaternion = read_quaternion(*orientation);
  if (!point || !quaternion) return std::nullopt;
  return Placement{*point, *quaternion};
}

void read_header(const Field& message, std::vector<Stamp>& stamps) {
  const auto header = message.optional_member("header");
  if (!header || !header->is_object()) return;
  if (const auto frame_id = header->optional_member("frame_id")) {
    const auto text = frame_id->to_text();
    // The measured server writes "darpa" over any other, saying nothing.
    if (text && *text != "darpa") frame_id->add_violation("expected \"darpa\" (ICD 6.1)", Measured::Takes);
  }
  if (const auto stamp = header->optional_member("stamp")) {
    const auto seconds = stamp->to_number();
    if (seconds && *seconds < 0) stamp->add_violation("expected seconds from 0");
    if (seconds && *seconds >= 0) stamps.push_back({*seconds, stamp->path()});
  }
}

}  // namespace adit::rehearsal
