#include <gtest/gtest.h>

#include "spare/stick.hpp"

namespace adit::spare {
namespace {

constexpr double kAt = 1795475760;  // 2026-11-23T23:16:00Z

TEST(ExportName, HasBoxAndTime) {
  EXPECT_EQ(file_name("10.0.0.1", kAt), "adit-10.0.0.1-20261123T231600Z.adit-spare");
  EXPECT_EQ(named_for(file_name("10.0.0.1", kAt)), (ExportName{"10.0.0.1", kAt}));
}

TEST(ExportName, ReplacesUnsafeCharacters) {
  EXPECT_EQ(file_name("../[fd00::1]:8000\n", kAt), "adit-..--fd00--1--8000--20261123T231600Z.adit-spare");
  EXPECT_TRUE(is_file_name(file_name("[fd00::1]:8000", kAt)));
  EXPECT_TRUE(is_file_name(file_name(std::string(1000, 'x'), kAt))) << "not too long either";
  EXPECT_TRUE(is_file_name(file_name("", -1)));
}

TEST(ExportName, AcceptsRenamedFiles) {
  for (const char* const name : {"export.adit-spare", "export (1).adit-spare", "Box A.adit-spare"}) {
    EXPECT_TRUE(is_file_name(name)) << name;
    EXPECT_EQ(named_for(name), ExportName{}) << name;
  }
}

TEST(ExportName, RejectsPathsAndControlCharacters) {
  for (const std::string& name :
       {std::string(".adit-spare"), std::string("._export.adit-spare"), std::string("a/b.adit-spare"),
        std::string("../b.adit-spare"), std::string("b\x1b[2J.adit-spare"), std::string("b\xff.adit-spare"),
        std::string("export.adit-spare.part"), std::string(), std::string("b\0.adit-spare", 13),
        std::string(200, 'x') + ".adit-spare"})
    EXPECT_FALSE(is_file_name(name)) << name;
}

TEST(ExportName, HasNoInvalidTime) {
  for (const char* const name :
       {"adit-10.0.0.1-20261323T231600Z.adit-spare", "adit-10.0.0.1-20260230T231600Z.adit-spare",
        "adit-10.0.0.1-2026.adit-spare", "adit-20261123T231600Z.adit-spare",
        "adit--20261123T231600Z.adit-spare", "adit-10.0.0.1-20261123T231600Zx.adit-spare"})
    EXPECT_EQ(named_for(name), ExportName{}) << name;
}

TEST(ExportName, SortsTheLaterExportFirst) {
  const std::string earlier = file_name("b", kAt), later = file_name("a", kAt + 1);
  EXPECT_TRUE(is_before(later, earlier));
  EXPECT_FALSE(is_before(earlier, later));
  EXPECT_TRUE(is_before(earlier, "export.adit-spare")) << "names without a time come last";
  EXPECT_TRUE(is_before("a.adit-spare", "b.adit-spare"));
  EXPECT_FALSE(is_before(later, later));
}

}  // namespace
}  // namespace adit::spare
