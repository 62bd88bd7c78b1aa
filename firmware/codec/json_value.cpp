#include "codec/json_value.hpp"

#include <cjson/cJSON.h>

#include <cmath>
#include <memory>
#include <string_view>

#include "codec/splitter.hpp"

namespace adit::codec {
namespace {

std::string text_of(const char* text) {
  constexpr std::string_view kStandsForNul = "\xEF\xBF\xBF";  // see JsonSplitter::rest_
  std::string result(text);
  for (std::size_t at = 0; (at = result.find(kStandsForNul, at)) != std::string::npos; ++at) {
    result.replace(at, kStandsForNul.size(), 1, '\0');
  }
  return result;
}

Value number_of(double number) {
  constexpr double kWholeBelow = 9007199254740992;  // 2^53: from there on it may stand for another integer
  const bool whole = std::abs(number) < kWholeBelow && number == std::floor(number);
  const bool negative_zero = number == 0 && std::signbit(number);
  if (whole && !negative_zero) return {static_cast<std::int64_t>(number)};
  return {number};
}

std::size_t children_of(const cJSON& item) {
  return static_cast<std::size_t>(cJSON_GetArraySize(&item));
}

/// Recursion ends at BodyDecoder::kDeepest.
Value value_of(const cJSON& item, Lists* lists) {
  if (cJSON_IsBool(&item)) return {static_cast<bool>(cJSON_IsTrue(&item))};
  if (cJSON_IsNumber(&item)) return number_of(item.valuedouble);
  if (cJSON_IsString(&item)) return {text_of(item.valuestring)};
  if (cJSON_IsArray(&item)) {
    if (lists != nullptr) return lists->next();
    Value::Array array;
    array.reserve(children_of(item));
    for (const cJSON* element = item.child; element != nullptr; element = element->next) {
      array.push_back(value_of(*element, nullptr));
    }
    return {std::move(array)};
  }
  if (cJSON_IsObject(&item)) {
    Value::Object object;
    object.reserve(children_of(item));
    for (const cJSON* member = item.child; member != nullptr; member = member->next) {
      object.emplace_back(text_of(member->string), value_of(*member, lists));
    }
    return {std::move(object)};
  }
  return {};
}

/// The value from `begin` to `end`.
icd::Checked<Value> with_lists(const Text& text, std::size_t begin, std::size_t end) {
  Cut cut = cut_json(*text, begin, end);
  if (cut.values > kMostOutsideLists) return std::unexpected(too_many_outside_lists(kMostOutsideLists));
  Lists lists(text, std::move(cut.arrays), with_lists, 1);
  return json_value(cut.rest, &lists);
}

}  // namespace

icd::Checked<Value> json_value(const std::string& text, Lists* lists) {
  constexpr bool kNothingAfter = true;
  const std::unique_ptr<cJSON, decltype(&cJSON_Delete)> root(
      cJSON_ParseWithLengthOpts(text.c_str(), text.size() + 1, nullptr, kNothingAfter), &cJSON_Delete);
  if (root == nullptr) {  // of what a JsonSplitter has passed, only for want of memory
    return std::unexpected(
        icd::Refusal{icd::Status::InternalServerError, "the JSON document could not be parsed"});
  }
  return value_of(*root, lists);
}

icd::Checked<Value> json_value_with_lists(std::string text) {
  const auto kept = std::make_shared<const std::string>(std::move(text));
  return with_lists(kept, 0, kept->size());
}

}  // namespace adit::codec
