#pragma once

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <string>
#include <string_view>

#include "codec/body_decoder.hpp"

/// Helpers for tests of the byte level: bodies in chunks, and comparison with documents that nlohmann-json
/// read.
namespace adit::codec::test {

inline constexpr BodyKind kJsonBody{Format::Json, ContentCoding::Identity};
inline constexpr BodyKind kCborBody{Format::Cbor, ContentCoding::Identity};

inline icd::Checked<Document> decode_in_chunks(BodyKind kind, Split split, std::string_view body,
                                               std::size_t size, const Limits& limits = {}) {
  BodyDecoder decoder(kind, split, limits);
  for (; !body.empty(); body.remove_prefix(std::min(size, body.size()))) {
    const std::string_view chunk = body.substr(0, size);
    const auto fed = decoder.feed({reinterpret_cast<const std::uint8_t*>(chunk.data()), chunk.size()});
    if (!fed) return std::unexpected(fed.error());
  }
  return decoder.finish();
}

/// Decodes the body in chunks of random sizes, at most `most` and at most a random limit. Some chunks are
/// empty.
inline icd::Checked<Document> decode_in_random_chunks(BodyKind kind, Split split, std::string_view body,
                                                      std::mt19937_64& random, std::size_t most = 40,
                                                      const Limits& limits = {}) {
  BodyDecoder decoder(kind, split, limits);
  most = 1 + random() % most;
  while (!body.empty()) {
    const std::string_view chunk = body.substr(0, random() % (most + 1));
    body.remove_prefix(chunk.size());
    const auto fed = decoder.feed({reinterpret_cast<const std::uint8_t*>(chunk.data()), chunk.size()});
    if (!fed) return std::unexpected(fed.error());
  }
  return decoder.finish();
}

inline constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

inline std::string base64_of(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t at) { return at < bytes.size() ? bytes[at] : std::uint8_t{0}; };
    const unsigned group = byte(i) << 16U | byte(i + 1) << 8U | byte(i + 2);
    for (const unsigned shift : {18U, 12U, 6U, 0U}) text += kBase64[group >> shift & 63U];
  }
  for (std::size_t i = 0; i < (3 - bytes.size() % 3) % 3; ++i) text[text.size() - 1 - i] = '=';
  return text;
}

/// Bytes from hexadecimal digits such as "83 01 ff".
inline std::string from_hex(std::string_view digits) {
  std::string bytes;
  std::string pair;
  for (const char c : digits) {
    if (c != ' ') pair += c;
    if (pair.size() < 2) continue;
    bytes += static_cast<char>(std::stoi(pair, nullptr, 16));
    pair.clear();
  }
  return bytes;
}

/// Whether `value` equals `expected`: the same members in the same order, and numbers of the same value.
inline bool equals(const Value& value, const nlohmann::ordered_json& expected) {
  if (const auto* whole = std::get_if<std::int64_t>(&value.is)) {
    return expected.is_number() && expected.get<double>() == static_cast<double>(*whole) &&
           (expected.is_number_float() || expected.get<std::int64_t>() == *whole);
  }
  if (const auto* whole = std::get_if<std::uint64_t>(&value.is)) {
    return expected.is_number_unsigned() && expected.get<std::uint64_t>() == *whole;
  }
  if (const auto* number = std::get_if<double>(&value.is)) {
    return expected.is_number() && expected.get<double>() == *number;
  }
  if (const auto* text = std::get_if<std::string>(&value.is)) {
    return expected.is_string() && expected.get_ref<const std::string&>() == *text;
  }
  if (const auto* boolean = std::get_if<bool>(&value.is))
    return expected.is_boolean() && expected == *boolean;
  if (const auto* bytes = std::get_if<Value::Bytes>(&value.is)) {
    return expected.is_binary() && std::ranges::equal(expected.get_binary(), bytes->bytes);
  }
  if (const auto* array = std::get_if<Value::Array>(&value.is)) {
    return expected.is_array() &&
           std::equal(array->begin(), array->end(), expected.begin(), expected.end(), equals);
  }
  if (const auto* object = std::get_if<Value::Object>(&value.is)) {
    if (!expected.is_object() || expected.size() != object->size()) return false;
    auto member = object->begin();
    for (const auto& [key, child] : expected.items()) {
      if (member->first != key || !equals(member->second, child)) return false;
      ++member;
    }
    return true;
  }
  return std::holds_alternative<std::nullptr_t>(value.is) && expected.is_null();
}

inline const Value* msg_data(const Value& root) {
  const Value* at = &root;
  for (const std::string_view name : {"msg", "data"}) {
    const auto* object = std::get_if<Value::Object>(&at->is);
    if (object == nullptr) return nullptr;
    const auto found = std::ranges::find(*object, name, &Value::Member::first);
    if (found == object->end()) return nullptr;
    at = &found->second;
  }
  return at;
}

}  // namespace adit::codec::test
