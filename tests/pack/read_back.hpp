#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "codec/write.hpp"
#include "icd/mapping.hpp"
#include "rehearsal/command_post/messages.hpp"

namespace adit::pack {

/// A cloud as the rehearsal's Command Post reads it, with code of its own.
struct ReadBack {
  rehearsal::Cloud cloud;
  std::string data;
};

inline ReadBack read_back(const icd::MapUpdate& map) {
  const auto document =
      rehearsal::read_document(codec::write_map_update(map).to_string(), rehearsal::Format::CborBytes);
  EXPECT_TRUE(document);
  rehearsal::Findings findings;
  auto message = rehearsal::read_map(document->value, rehearsal::Format::CborBytes, findings);
  EXPECT_EQ(findings.first_rejected(rehearsal::Manner::Strict), nullptr);
  EXPECT_EQ(findings.first_rejected(rehearsal::Manner::AsMeasured), nullptr);
  EXPECT_TRUE(message);
  if (!message) return {};
  return {std::get<rehearsal::Cloud>(message->msg), std::move(message->data)};
}

/// For each point the bytes of its fields, without the named ones, in the list's order.
template <class Fields>
std::vector<std::string> values_of(const Fields& fields, std::size_t step, const std::string& data,
                                   const std::vector<std::string>& but = {}) {
  std::vector<std::string> points;
  for (std::size_t at = 0; at + step <= data.size(); at += step) {
    std::string values;
    for (const auto& field : fields) {
      if (std::ranges::find(but, field.name) != but.end()) continue;
      const std::size_t size = size_of_datatype(static_cast<int>(field.datatype));
      values += data.substr(at + field.offset, size * field.count);
    }
    points.push_back(std::move(values));
  }
  return points;
}

}  // namespace adit::pack
