#include "intake/head.hpp"

#include <utility>

#include "icd/letter_case.hpp"
#include "icd/text.hpp"

namespace adit::intake {

HeadParts parts_of(std::string_view head) {
  head.remove_prefix(head.find_first_not_of("\r\n"));  // RFC 9112 2.2: empty lines before it
  const std::string_view line = head.substr(0, head.find('\r'));
  const auto first = line.find(' '), last = line.rfind(' ');
  return {.method = line.substr(0, first),
          .target = line.substr(first + 1, last - first - 1),
          .fields = head.substr(line.size() + 2)};
}

Head::Head(std::string text, Target target, const std::string& peer, const std::string& local,
           std::optional<std::uint64_t> length)
    : text_(std::move(text)), target_(std::move(target)), peer_(peer), local_(local), length_(length) {
  const HeadParts parts = parts_of(text_);
  method_ = parts.method;
  fields_.reserve(16);
  for (std::string_view left = parts.fields; !left.starts_with('\r');) {
    const std::string_view line = left.substr(0, left.find('\r'));
    const std::string_view name = line.substr(0, line.find(':'));
    fields_.push_back({.name = name, .value = icd::trimmed(line.substr(name.size() + 1), kBlanks)});
    left.remove_prefix(line.size() + 2);
  }
}

std::string_view Head::query(std::string_view name) const {
  for (const auto& [key, value] : target_.query) {
    if (key == name) return value;
  }
  return {};
}

std::string_view Head::header(std::string_view name) const {
  for (const FieldLine& field : fields_) {
    if (icd::same_but_for_case(field.name, name)) return field.value;
  }
  return {};
}

}  // namespace adit::intake
