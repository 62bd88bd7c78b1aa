#include "codec/cbor_value.hpp"

#include <cbor.h>

#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "codec/splitter.hpp"
#include "codec/utf8.hpp"

namespace adit::codec {
namespace {

struct Release {
  void operator()(cbor_item_t* item) const { cbor_decref(&item); }
};
using Item = std::unique_ptr<cbor_item_t, Release>;

Value negative(std::uint64_t argument) {  // RFC 8949 3.1: the value is -1 - argument
  if (argument <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return {-1 - static_cast<std::int64_t>(argument)};
  }
  return {-1.0 - static_cast<double>(argument)};
}

Value whole(std::uint64_t number) {
  if (number <= static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())) {
    return {static_cast<std::int64_t>(number)};
  }
  return {number};
}

std::vector<std::uint8_t> bytes_of(const cbor_item_t& item) {
  std::vector<std::uint8_t> bytes;
  const auto append = [&bytes](const cbor_item_t& piece) {
    const unsigned char* const first = cbor_bytestring_handle(&piece);
    bytes.insert(bytes.end(), first, first + cbor_bytestring_length(&piece));
  };
  if (cbor_bytestring_is_definite(&item)) {
    append(item);
    return bytes;
  }
  for (const cbor_item_t* chunk :
       std::span(cbor_bytestring_chunks_handle(&item), cbor_bytestring_chunk_count(&item))) {
    append(*chunk);
  }
  return bytes;
}

std::string text_of(const cbor_item_t& item) {
  std::string text;
  const auto append = [&text](const cbor_item_t& piece) {
    text.append(reinterpret_cast<const char*>(cbor_string_handle(&piece)), cbor_string_length(&piece));
  };
  if (cbor_string_is_definite(&item)) {
    append(item);
    return text;
  }
  for (const cbor_item_t* chunk :
       std::span(cbor_string_chunks_handle(&item), cbor_string_chunk_count(&item))) {
    append(*chunk);
  }
  return text;
}

/// A member's name: a text, or a byte string that holds one, as Python 2 writes it. Nothing for another key.
std::optional<std::string> name_of(const cbor_item_t& key) {
  if (cbor_isa_string(&key)) return text_of(key);
  if (!cbor_isa_bytestring(&key)) return std::nullopt;
  const auto bytes = bytes_of(key);
  std::string name(bytes.begin(), bytes.end());
  return is_utf8(name) ? std::optional(std::move(name)) : std::nullopt;
}

Value simple(const cbor_item_t& item) {
  if (cbor_is_float(&item)) return {cbor_float_get_float(&item)};
  if (cbor_is_bool(&item)) return {cbor_get_bool(&item)};
  return {};
}

/// Recursion ends at BodyDecoder::kDeepest.
Value value_of(const cbor_item_t& item, Lists* lists) {
  switch (cbor_typeof(&item)) {
    case CBOR_TYPE_UINT:
      return whole(cbor_get_int(&item));
    case CBOR_TYPE_NEGINT:
      return negative(cbor_get_int(&item));
    case CBOR_TYPE_BYTESTRING:
      return {Value::Bytes{bytes_of(item)}};
    case CBOR_TYPE_STRING:
      return {text_of(item)};
    case CBOR_TYPE_ARRAY: {
      if (lists != nullptr) return lists->next();
      Value::Array array;
      array.reserve(cbor_array_size(&item));
      for (const cbor_item_t* element : std::span(cbor_array_handle(&item), cbor_array_size(&item))) {
        array.push_back(value_of(*element, nullptr));
      }
      return {std::move(array)};
    }
    case CBOR_TYPE_MAP: {
      Value::Object object;
      object.reserve(cbor_map_size(&item));
      for (const cbor_pair& pair : std::span(cbor_map_handle(&item), cbor_map_size(&item))) {
        auto name = name_of(*pair.key);
        if (!name) (void)value_of(*pair.key, lists);  // with its lists
        Value value = value_of(*pair.value, lists);
        if (name) object.emplace_back(*std::move(name), std::move(value));
      }
      return {std::move(object)};
    }
    case CBOR_TYPE_TAG:  // a CborSplitter leaves none
    case CBOR_TYPE_FLOAT_CTRL:
      break;
  }
  return simple(item);
}

/// The value from `begin` on.
icd::Checked<Value> with_lists_at(const Text& text, std::size_t begin, std::size_t /*end*/) {
  Cut cut = cut_cbor(*text, begin);
  if (cut.values > kMostOutsideLists) return std::unexpected(too_many_outside_lists(kMostOutsideLists));
  Lists lists(text, std::move(cut.arrays), with_lists_at, 0);
  return cbor_value(cut.rest, &lists);
}

}  // namespace

icd::Checked<Value> cbor_value(const std::string& bytes, Lists* lists) {
  cbor_load_result result{};
  const Item root(cbor_load(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(), &result));
  if (root == nullptr) {  // only for want of memory: the bytes are known to be well-formed
    return std::unexpected(
        icd::Refusal{icd::Status::InternalServerError, "the CBOR document could not be parsed"});
  }
  return value_of(*root, lists);
}

icd::Checked<Value> cbor_value_with_lists(std::string bytes) {
  return with_lists_at(std::make_shared<const std::string>(std::move(bytes)), 0, 0);
}

}  // namespace adit::codec
