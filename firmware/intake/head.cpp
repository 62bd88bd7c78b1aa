#include "intake/head.hpp"

#include <microhttpd.h>

#include <algorithm>
#include <cctype>
#include <charconv>

namespace adit::intake {
namespace {

bool same_word(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

/// The fields that say where the body ends, as they stand in the head.
struct FramingFields {
  int lengths = 0, codings = 0;
  std::string_view length, coding;
};

MHD_Result collect(void* cls, MHD_ValueKind, const char* key, size_t key_size, const char* value,
                   size_t value_size) {
  auto& fields = *static_cast<FramingFields*>(cls);
  const std::string_view name(key, key_size);
  const std::string_view text(value == nullptr ? "" : value, value_size);
  if (same_word(name, "Content-Length")) {
    ++fields.lengths;
    fields.length = text;
  } else if (same_word(name, "Transfer-Encoding")) {
    ++fields.codings;
    fields.coding = text;
  }
  return MHD_YES;
}

std::optional<std::uint64_t> whole_number(std::string_view text) {
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace

Framing framing_of(MHD_Connection* connection) {
  FramingFields fields;
  MHD_get_connection_values_n(connection, MHD_HEADER_KIND, &collect, &fields);
  Framing framing;
  if (fields.codings > 0) {
    framing.has_body = true;
    if (fields.lengths > 0) {
      framing.trouble = "Content-Length: must not stand beside Transfer-Encoding";
    } else if (fields.codings > 1 || !same_word(fields.coding, "chunked")) {
      framing.trouble = "Transfer-Encoding: expected chunked and nothing else";
    }
  } else if (fields.lengths > 0) {
    framing.length = whole_number(fields.length);
    framing.has_body = !framing.length || *framing.length > 0;
    if (fields.lengths > 1) {
      framing.trouble = "Content-Length: given twice";
    } else if (!framing.length) {
      framing.trouble = "Content-Length: expected a whole number";
    }
  } else {
    framing.length = 0;
  }
  return framing;
}

std::string_view Head::query(std::string_view name) const {
  for (const auto& [key, value] : target_.query) {
    if (key == name) return value;
  }
  return {};
}

std::string_view Head::header(std::string_view name) const {
  const char* value = nullptr;
  std::size_t size = 0;
  if (MHD_lookup_connection_value_n(connection_, MHD_HEADER_KIND, name.data(), name.size(), &value, &size) !=
          MHD_YES ||
      value == nullptr) {
    return {};
  }
  return {value, size};
}

}  // namespace adit::intake
