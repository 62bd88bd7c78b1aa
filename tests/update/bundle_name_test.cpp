#include "update/bundle_name.hpp"

#include <gtest/gtest.h>

namespace adit::update {
namespace {

TEST(BundleName, BeginsAndEndsAsUpdatesDo) {
  EXPECT_TRUE(is_bundle_name("adit-qemu-virt-0.2.0.raucb"));
  EXPECT_TRUE(is_bundle_name("adit-.raucb"));
  for (const char* other :
       {"", "adit-", ".raucb", "adit-x.raucb.part", "ADIT-X.RAUCB", "other.raucb", "adit.raucb"}) {
    EXPECT_FALSE(is_bundle_name(other)) << other;
  }
}

TEST(BundleName, IsPlainOfVisibleAsciiAndSpaces) {
  EXPECT_TRUE(is_plain("adit-x 1.0.0 (copy)~.raucb"));
  for (const char* other : {"adit-\xe4.raucb", "adit-\xc3\xa4.raucb", "adit-\n.raucb", "adit-\x7f.raucb"}) {
    EXPECT_FALSE(is_plain(other)) << other;
  }
}

TEST(BundleName, PromisesTheMoreTheNewerTheVersionForThisBoard) {
  const std::vector<std::string> ascending = {
      "adit-generic-x86_64-9.0.0.raucb", "adit-rock-pi-newest.raucb", "adit-rock-pi-0.9.0.raucb",
      "adit-rock-pi-0.10.0-rc.1.raucb",  "adit-rock-pi-0.10.0.raucb",
  };
  for (std::size_t i = 0; i < ascending.size(); ++i) {
    for (std::size_t j = 0; j < ascending.size(); ++j) {
      EXPECT_TRUE((promise_of(ascending[i], "adit-rock-pi") <=> promise_of(ascending[j], "adit-rock-pi")) ==
                  (i <=> j))
          << ascending[i] << " and " << ascending[j];
    }
  }
}

TEST(BundleName, OfABoardWhoseNameBeginsAlikePromisesNoVersion) {
  EXPECT_EQ(promise_of("adit-rock-pi-e-9.0.0.raucb", "adit-rock-pi").version, std::nullopt);
  EXPECT_FALSE(promise_of("adit-rock-pies.raucb", "adit-rock-pi").for_this_board);
  EXPECT_FALSE(promise_of("adit-rock-pi.raucb", "adit-rock-pi").for_this_board);
  EXPECT_FALSE(promise_of("", "adit-rock-pi").for_this_board);
}

}  // namespace
}  // namespace adit::update
