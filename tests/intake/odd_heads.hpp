#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace adit::intake {

/// A head that RFC 9110 or 9112 forbids.
struct OddHead {
  std::string_view clause, what;
  std::string head;
  int status;
  std::string_view word;  // in the sentence
};

const std::vector<OddHead>& odd_heads();

/// A chunked body that RFC 9112 7.1 forbids.
struct OddChunks {
  std::string_view what;
  std::string body;
};

const std::vector<OddChunks>& odd_chunks();

}  // namespace adit::intake
