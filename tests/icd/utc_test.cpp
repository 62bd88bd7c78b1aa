#include <gtest/gtest.h>

#include <limits>

#include "icd/sentence.hpp"

namespace adit::icd {
namespace {

TEST(Utc, IsADateOrNothing) {
  EXPECT_EQ(utc(86399.9), "1970-01-01 23:59:59");
  EXPECT_EQ(utc(1795420800), "2026-11-23 08:00:00");
  EXPECT_EQ(utc(4102444800), "2100-01-01 00:00:00");
  for (const double none :
       {0.0, -1.0, 1e300, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_EQ(utc(none), "") << none;
}

}  // namespace
}  // namespace adit::icd
