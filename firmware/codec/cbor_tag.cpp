#include "codec/cbor_tag.hpp"

#include <algorithm>
#include <array>

#include "icd/sentence.hpp"

namespace adit::codec {

bool is_remark(std::uint64_t tag) {
  static constexpr auto kRemarks = std::to_array<std::uint64_t>({
      0,     1,                      // time as text, and in seconds
      21,    22,    23,  108,        // preferred encoding of bytes
      28,    256,   296, 22098,      // reference scopes; references (25, 29) are no annotations
      32,    33,    34,  35,    36,  // kinds of text
      39,                            // an identifier
      41,    258,                    // of an array: equal types; a set
      64,    68,    72,              // RFC 8746: bytes as an array of single bytes
      201,   55799,                  // content is CBOR
      259,   275,                    // of a map: a map; text keys
      266,   267,   301, 1004,       // more kinds of text
      21065,
  });
  return std::ranges::find(kRemarks, tag) != kRemarks.end();
}

std::string tag_that_changes(std::uint64_t tag) {
  return icd::sentence("CBOR tag ", tag, ", which changes the meaning of its value");
}

}  // namespace adit::codec
