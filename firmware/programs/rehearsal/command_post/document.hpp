#pragma once

#include <cstddef>
#include <cstdint>
#include <expected>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "icd/text.hpp"
#include "rehearsal/agreed.hpp"

namespace adit::rehearsal {

/// A received document.
using Json = nlohmann::json;

/// A document to send: members stay in the order they were written.
using OrderedJson = nlohmann::ordered_json;

/// One line of JSON; bytes that are not UTF-8 become U+FFFD, since names from the wire may hold anything.
template <class AnyJson>
std::string line_of(const AnyJson& value) {
  return value.dump(-1, ' ', false, AnyJson::error_handler_t::replace);
}

/// A well-formed body, and its faults.
struct Document {
  Json value;
  std::optional<std::string> repeated;  // a member that some object holds twice
};

enum class Format : std::uint8_t { JsonText, CborBytes };

/// Reads a whole body: JSON (RFC 8259, without a byte order mark) or CBOR (RFC 8949, text in UTF-8, no tags),
/// nothing after it, nested no deeper than 64, at most 4 million values. An error says why it is none.
std::expected<Document, std::string> read_document(std::string_view body, Format format);

/// RFC 4648 4: the standard alphabet, padded, with no other character in it; otherwise std::nullopt.
std::optional<std::string> base64_decoded(std::string_view text);

enum class InflateFault {
  Broken,    // no such stream, cut short, or a wrong checksum
  TooLarge,  // grows over the limit
  Followed,  // one whole stream, and bytes after it (a second member, or anything else)
};

/// Exactly one gzip member (RFC 1952), of at most `most` bytes once inflated.
std::expected<std::string, InflateFault> gunzip(std::string_view bytes, std::size_t most);

/// A body under Content-Encoding: deflate, which clients send as zlib (RFC 1950) or bare (RFC 1951).
std::expected<std::string, InflateFault> inflate_body(std::string_view bytes, std::size_t most);

/// Which Command Post is played: the ICD's, to the letter, or the measured test servers.
enum class Manner { Strict, AsMeasured };

/// What the measured mapping server does about something that a strict one refuses.
enum class Measured { Takes, Refuses, Dies, Hangs };

/// One thing found in a message: a row of the table 'what the ICD says, what the server does'.
struct Finding {
  std::string sentence;    // names the field by its path
  int status = 422;        // of the refusal, in either manner
  bool breaks_icd = true;  // else only the measured server minds
  Measured measured = Measured::Refuses;
  bool strict_refuses = true;  // if it breaks the ICD
};

/// Whether a Command Post of that manner refuses a message for it.
inline bool decides(const Finding& finding, Manner manner) {
  return manner == Manner::Strict ? finding.breaks_icd && finding.strict_refuses
                                  : finding.measured != Measured::Takes;
}

/// The findings in one message, in the order of reading. Only the first kMost are kept.
class Findings {
 public:
  static constexpr std::size_t kMost = 20;
  static constexpr std::size_t kLongest = 400;

  /// The ICD forbids it.
  void add_violation(std::string sentence, Measured measured = Measured::Refuses, int status = 422) {
    add({std::move(sentence), status, true, measured});
  }
  /// The ICD forbids it, and either manner takes the message all the same.
  void add_remark(std::string sentence) { add({std::move(sentence), 422, true, Measured::Takes, false}); }
  /// The ICD allows it, the measured server does not.
  void add_measured_refusal(std::string sentence) {
    add({std::move(sentence), 422, false, Measured::Refuses});
  }

  const std::vector<Finding>& all() const { return all_; }

  /// The first finding for which a Command Post of that manner rejects the message; null: it accepts it.
  const Finding* first_rejected(Manner manner) const {
    for (const Finding& finding : all_) {
      if (decides(finding, manner)) return &finding;
    }
    return nullptr;
  }

  /// The sentences of those that break the ICD.
  std::vector<std::string> violations() const {
    std::vector<std::string> sentences;
    for (const Finding& finding : all_) {
      if (finding.breaks_icd) sentences.push_back(finding.sentence);
    }
    return sentences;
  }

 private:
  void add(Finding finding) {
    if (finding.sentence.size() > kLongest) finding.sentence.resize(kLongest);  // it may quote the sender
    const auto is_first = [&](Manner manner) {
      return decides(finding, manner) && first_rejected(manner) == nullptr;
    };
    // A finding that decides must not be lost behind many that do not.
    if (all_.size() < kMost || is_first(Manner::Strict) || is_first(Manner::AsMeasured)) {
      all_.push_back(std::move(finding));
    }
  }
  std::vector<Finding> all_;
};

/// A value in a document: it knows its path ("msg.info.width") and records its errors as findings. A member
/// function that returns nothing has recorded the reason. Valid as long as the document and the findings are.
class Field {
 public:
  Field(const Json& value, std::string path, Findings& findings)
      : value_(&value), path_(std::move(path)), findings_(&findings) {}

  /// A required member; `measured`: the measured server's reaction if it is absent.
  std::optional<Field> member(const char* name, Measured measured = Measured::Refuses) const;
  /// A member that need not be there; writes nothing down.
  std::optional<Field> optional_member(const char* name) const;
  /// The elements of an array; nothing if this is no array.
  std::optional<std::vector<Field>> elements() const;

  bool is_object() const;                   // else writes that down
  std::optional<double> to_number() const;  // finite
  std::optional<std::int64_t> integer(std::int64_t least, std::int64_t most) const;
  std::optional<bool> boolean() const;
  std::optional<std::string> to_text() const;

  // The value of a member that must be there.
  std::optional<double> number(const char* name) const { return member(name).and_then(&Field::to_number); }
  std::optional<std::int64_t> integer(const char* name, std::int64_t least, std::int64_t most) const;
  std::optional<std::string> text(const char* name) const { return member(name).and_then(&Field::to_text); }

  const Json& value() const { return *value_; }
  const std::string& path() const { return path_; }
  Findings& findings() const { return *findings_; }

  /// Writes down "<path>: <what>". The result is empty, so that a reader can return it.
  std::nullopt_t add_violation(std::string_view what, Measured measured = Measured::Refuses) const;

 private:
  std::string path_of(std::string_view name) const;
  /// Writes down "<path>: expected <what>, got <a number, or the type>".
  std::nullopt_t report_mismatch(std::string_view what) const;

  const Json* value_;
  std::string path_;
  Findings* findings_;
};

/// All of `text` as a number from `low` to `high`, and nothing else.
template <class Number>
std::optional<Number> number_of(std::string_view text, Number low, Number high) {
  const auto number = icd::number_in<Number>(text);
  return number && *number >= low && *number <= high ? number : std::nullopt;  // not a number is neither
}

/// ASCII in lower case.
std::string lower(std::string text);

/// `text` with all but letters, digits and underscores made underscores, at most 32 characters: safe as part
/// of a file's name and as a word of a PCD header.
std::string sanitize(std::string_view text);

/// Whether `name` is one that a robot may have: 1 to 10 letters, digits and underscores (ICD 2).
bool is_robot_name(std::string_view name);

/// Whether it is one of the types of the final event, in any letter case (ICD 5.2).
bool is_artifact_type(std::string_view type);

/// A stamp and its path, so that the order of stamps can be checked (ICD 6.2).
struct Stamp {
  double seconds = 0;
  std::string path;
};

std::optional<Vector3> read_point(const Field& point);

/// `pose` has "position" and "orientation": a quaternion of length 1 (the measured server takes any).
std::optional<Placement> read_pose(const Field& pose);

/// The optional "header" of `message` (ICD 6.1, 6.2): frame_id must be "darpa"; a stamp is added to `stamps`.
void read_header(const Field& message, std::vector<Stamp>& stamps);

}  // namespace adit::rehearsal
