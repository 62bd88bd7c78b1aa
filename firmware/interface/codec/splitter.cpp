#include "codec/splitter.hpp"

#include "icd/sentence.hpp"

namespace adit::codec {
namespace {

/// Passes each member of that name to `visit`; without effect if `value` is not an object.
template <class Visit>
void each_member(Value& value, std::string_view name, const Visit& visit) {
  auto* const object = std::get_if<Value::Object>(&value.is);
  if (object == nullptr) return;
  for (auto& [key, member] : *object) {
    if (key == name) visit(member);
  }
}

}  // namespace

icd::Refusal bad_data(std::string_view why) {
  return {icd::Status::UnprocessableEntity, icd::sentence("msg.data: ", why)};
}

icd::Refusal KeptText::too_large() const {
  return {
      icd::Status::ContentTooLarge,
      icd::sentence("the document without its bulk data is larger than the limit of ", most_.text, " bytes")};
}

icd::Refusal KeptText::too_many_values() const {
  return {icd::Status::ContentTooLarge,
          icd::sentence("the document without its bulk data has more than the limit of ", most_.values,
                        " values")};
}

icd::Refusal too_many_outside_lists(std::size_t most) {
  return {icd::Status::ContentTooLarge,
          icd::sentence("more than the limit of ", most, " values outside lists")};
}

void mark_split_out(Value& root) {
  // A second "msg.data" was refused, so there is at most one.
  each_member(root, "msg",
              [](Value& msg) { each_member(msg, "data", [](Value& data) { data.is = Value::SplitOut{}; }); });
}

}  // namespace adit::codec
