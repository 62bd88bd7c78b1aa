#pragma once

#include <gtest/gtest.h>

#include <span>
#include <string>

#include "codec/icd_row.hpp"
#include "codec/read.hpp"

namespace adit::codec::test {

inline icd::Checked<icd::MapUpdate> read_map(Format format, const std::string& body,
                                             const icd::Rules& rules = {}) {
  auto document = decode({.format = format}, Split::MapData, body);
  if (!document) return std::unexpected(document.error());
  return read_map_update(std::move(*document), rules);
}

/// Checks the answer to each row in both formats. Only CBOR has NaN and infinities.
inline void expect_map_answers(std::span<const IcdRow> rows, const json& good, const icd::Rules& rules = {}) {
  for (const IcdRow& row : rows) {
    json message = good;
    row.change(message);
    EXPECT_EQ(sentence_of(read_map(Format::Cbor, as_cbor(message), rules)), row.sentence)
        << "ICD " << row.section << ", CBOR";
    if (row.sentence.ends_with("nan") || row.sentence.ends_with("inf")) continue;
    EXPECT_EQ(sentence_of(read_map(Format::Json, as_json(message), rules)), row.sentence)
        << "ICD " << row.section << ", JSON";
  }
}

}  // namespace adit::codec::test
