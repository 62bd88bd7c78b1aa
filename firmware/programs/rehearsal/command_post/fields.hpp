#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "rehearsal/command_post/findings.hpp"
#include "rehearsal/command_post/json.hpp"

namespace adit::rehearsal {

/// A value somewhere in a document: it knows its path ("msg.info.width") and writes down what is wrong with
/// it. Whatever gives nothing has written down why. Valid as long as the document and the findings are.
class Field {
 public:
  Field(const Json& value, std::string path, Findings& findings)
      : value_(&value), path_(std::move(path)), findings_(&findings) {}

  /// A member that must be there; `measured`: what the measured server does where it is not.
  std::optional<Field> member(const char* name, Measured measured = Measured::Refuses) const;
  /// A member that need not be there; writes nothing down.
  std::optional<Field> optional_member(const char* name) const;
  /// The elements of an array; nothing where this is none.
  std::optional<std::vector<Field>> elements() const;

  bool is_object() const;                // else writes that down
  std::optional<double> number() const;  // finite
  std::optional<std::int64_t> integer(std::int64_t least, std::int64_t most) const;
  std::optional<bool> boolean() const;
  std::optional<std::string> text() const;

  const Json& value() const { return *value_; }
  const std::string& path() const { return path_; }
  Findings& findings() const { return *findings_; }

  /// Writes down "<path>: <what>".
  void breaks(std::string_view what, Measured measured = Measured::Refuses) const;

 private:
  std::string path_of(std::string_view name) const;
  void expected(std::string_view what) const;  // "<path>: expected <what>, got <kind of value>"

  const Json* value_;
  std::string path_;
  Findings* findings_;
};

/// A letter, a digit or an underscore, of ASCII.
bool is_word_character(char c);

/// Whether `name` is one that a robot may have: 1 to 10 letters, digits and underscores (ICD 2).
bool is_robot_name(std::string_view name);

}  // namespace adit::rehearsal
