#include "cli/table.hpp"

#include <gtest/gtest.h>

namespace adit::cli {
namespace {

using Align = Table::Align;

TEST(Table, AlignsItsColumns) {
  Table table({{"robot"}, {"sent", Align::Right}, {"said"}});
  table.add({{"r1"}, {"7"}, {"200"}});
  table.add({{"robot_long"}, {"12345"}, {"422: no"}});
  EXPECT_EQ(table.to_text(false),
            "  robot        sent  said\n"
            "  r1              7  200\n"
            "  robot_long  12345  422: no\n");
}

TEST(Table, HasNoTrailingSpaces) {
  Table table({{"a"}, {"b", Align::Right}, {"c"}});
  table.add({{"x"}, {""}, {""}});
  table.add({{""}, {"22"}, {"z"}});
  EXPECT_EQ(table.to_text(false),
            "  a   b  c\n"
            "  x\n"
            "     22  z\n");
}

TEST(Table, KeepsItsColumnsIfTextIsColoured) {
  Table table({{}, {}});
  table.add({{"NO", Tone::Bad}, {"x"}});
  table.add({{"late"}, {"y"}});
  EXPECT_EQ(table.to_text(true), "  \033[1;31mNO\033[0m    x\n  late  y\n");
}

TEST(Table, EscapesForeignText) {
  Table table(std::vector<Table::Column>(1));
  table.add({{"\033[2Jr1\n"}});
  EXPECT_EQ(table.to_text(true), "  \\x1b[2Jr1\\x0a\n");
}

TEST(Table, NamesAnErrorsStatusOnce) {
  EXPECT_EQ(answer_of(200, ""), "accepted");
  EXPECT_EQ(answer_of(422, "x: not a number"), "error 422: x: not a number");
  EXPECT_EQ(answer_of(500, "the Command Post answered 500"), "the Command Post answered 500");
  EXPECT_EQ(answer_of(0, "no answer"), "no answer");
}

TEST(Table, CountsCharactersAndNotBytes) {
  Table table({{}, {}});
  table.add({{"Höhle"}, {"a"}});
  table.add({{"r1"}, {"b"}});
  EXPECT_EQ(table.to_text(false), "  Höhle  a\n  r1     b\n");
}

}  // namespace
}  // namespace adit::cli
