#pragma once

#include <expected>
#include <utility>

/// The value of a std::expected. If it has an error instead, the calling function returns that error. Use it
/// only as a whole statement, or at the start of the right side of a declaration.
#define ADIT_TRY(...)                                                       \
  __extension__({                                                           \
    auto adit_tried = (__VA_ARGS__);                                        \
    if (!adit_tried) return std::unexpected(std::move(adit_tried).error()); \
    *std::move(adit_tried);                                                 \
  })
