#include "update/bundle.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "icd/sentence.hpp"

namespace adit::update {
namespace {

using testing::HasSubstr;

const RunningSystem kRunning = {"adit-qemu-virt", "0.2.0", "A", "B"};

TEST(Bundle, IsReadFromTheOutputOfRauc) {
  const auto bundle = read_info(
      R"({"compatible":"adit-qemu-virt","version":"0.2.0","description":null,"build":"abc","hooks":[],"images":[]})");
  ASSERT_TRUE(bundle) << bundle.error();
  EXPECT_EQ(bundle->compatible, "adit-qemu-virt");
  EXPECT_EQ(bundle->version, "0.2.0");
}

TEST(Bundle, IsInvalidWithoutOutputOfRauc) {
  for (const char* said :
       {"", "rauc-Message", "[]", "null", "{}", R"({"compatible":"adit-x","version":null})",
        R"({"version":"1.0.0"})", R"({"compatible":3,"version":"1.0.0"})"}) {
    EXPECT_FALSE(read_info(said)) << said;
  }
}

TEST(Bundle, IsRecognizedByItsFirstBytes) {
  std::vector<std::uint8_t> head(kBundleHead);
  head[0] = 'h', head[1] = 's', head[2] = 'q', head[3] = 's', head[41] = 1;  // of 256 bytes
  EXPECT_EQ(bundle_error(head, 257), "");
  EXPECT_EQ(bundle_error(head, 256), "the update is incomplete: expected more than 256 bytes, got 256");
  for (std::size_t at = 40; at < kBundleHead; ++at) head[at] = 0xff;
  EXPECT_NE(bundle_error(head, ~std::uint64_t{0}), "");
  EXPECT_NE(bundle_error(std::span(head).first(kBundleHead - 1), 257), "");
  EXPECT_NE(bundle_error({}, 257), "");
  head[3] = 'S';
  EXPECT_EQ(bundle_error(head, 257), "the file is not an update: expected a file adit-BOARD-VERSION.raucb");
}

TEST(RunningSlot, IsReadFromTheStatusOfRauc) {
  const auto running = read_status(R"({"compatible":"adit-qemu-virt","variant":"","booted":"B",
    "boot_primary":"rootfs.1","slots":[
      {"rootfs.1":{"class":"rootfs","bootname":"B","state":"booted","parent":null}},
      {"boot.0":{"class":"boot","bootname":null,"state":"inactive","parent":"rootfs.0"}},
      {"rootfs.0":{"class":"rootfs","bootname":"A","state":"inactive","parent":null}}]})");
  ASSERT_TRUE(running) << running.error();
  EXPECT_EQ(*running, (RunningSystem{"adit-qemu-virt", "", "B", "A"}));
}

TEST(RunningSlot, TellsIfTheOtherSlotIsNext) {
  for (const auto& [primary, next] :
       {std::pair(R"("rootfs.0")", true), std::pair(R"("rootfs.1")", false), std::pair("null", false)}) {
    const auto running = read_status(
        icd::sentence(R"({"compatible":"a","booted":"B","boot_primary":)", primary,
                      R"(,"slots":[{"rootfs.1":{"bootname":"B"}},{"rootfs.0":{"bootname":"A"}}]})"));
    ASSERT_TRUE(running) << running.error();
    EXPECT_EQ(running->other_next, next) << primary;
  }
}

TEST(RunningSlot, TellsIfTheOtherSlotHasTriesLeft) {
  for (const auto& [status, good] :
       {std::pair(R"(,"boot_status":"good")", true), std::pair(R"(,"boot_status":"bad")", false),
        std::pair(R"(,"boot_status":null)", false), std::pair("", false)}) {
    const auto running = read_status(icd::sentence(
        R"({"compatible":"a","booted":"B","slots":[{"rootfs.1":{"bootname":"B","boot_status":"good"}},)",
        R"({"rootfs.0":{"bootname":"A")", status, "}}]}"));
    ASSERT_TRUE(running) << running.error();
    EXPECT_EQ(running->other_good, good) << status;
  }
}

TEST(RunningSlot, IsUnknownWithoutAnotherSlot) {
  for (const char* said :
       {"", "{}", R"({"compatible":"a","booted":"A"})", R"({"compatible":"a","booted":"A","slots":{}})",
        R"({"compatible":"a","booted":null,"slots":[]})",
        R"({"compatible":"a","booted":"A","slots":[1,{},[]]})",
        R"({"compatible":"a","booted":"A","slots":[{"rootfs.0":{"bootname":"A"}}]})",
        R"({"compatible":"a","booted":"A","slots":[{"rootfs.0":{"bootname":7}}]})"}) {
    EXPECT_FALSE(read_status(said)) << said;
  }
}

TEST(Progress, IsTheNumberBeforeThePercentSign) {
  EXPECT_EQ(percent_in("  0% Installing"), 0);
  EXPECT_EQ(percent_in(" 40% Verifying signature done."), 40);
  EXPECT_EQ(percent_in("100% Installing done."), 100);
  for (const char* line :
       {"", "   ", "installing", "LastError: 40% of it", "40", "101% x", "-1% x", "4 0% x"}) {
    EXPECT_EQ(percent_in(line), std::nullopt) << line;
  }
}

TEST(Fault, IsTheLastLineOfRauc) {
  EXPECT_EQ(fault_in("", "rauc-Message: 15:05:30.310: Reading bundle: x\nfailed to open x\n").sentence,
            "failed to open x");
  EXPECT_EQ(fault_in("installing\n100% Installing failed.\nLastError: No space left on device\nidle\n",
                     "rauc-Message: 1\nInstalling `x` failed\n"),
            (Fault{Fault::Kind::Other, "No space left on device"}));
  EXPECT_EQ(fault_in("", "rauc-Message: 1\n"), Fault{});
  EXPECT_EQ(fault_in("", std::string(5000, 'x')).sentence.size(), 300u);
}

TEST(Fault, TellsADamagedFileAndWhatToDo) {
  for (const std::string& said :
       {"Installation error: Failed updating slot rootfs.1: Failed splicing data: Error reading from file "
        "descriptor: Input/output error",
        "Invalid bundle format: Signature size (17357689848845855539) exceeds bundle size",
        "signature verification failed: error:0200008A:rsa routines::invalid padding"}) {
    EXPECT_EQ(fault_in("", said + '\n').sentence,
              "the update's file is damaged: download or copy it again (RAUC: " + said + ")");
  }
  const std::string full = "Failed splicing data: Error writing to file descriptor: No space left on device";
  EXPECT_EQ(fault_in("", full).sentence, full) << "the file is whole";
  EXPECT_THAT(fault_in("", "signature verification failed: Verify error: self-signed certificate\n").sentence,
              HasSubstr("signed by a key that this box does not accept (RAUC: "));
}

TEST(Fault, TellsThatRaucIsBusy) {
  const Fault fault =
      fault_in("", "Error retrieving slot status via D-Bus: already processing a different method\n");
  EXPECT_EQ(fault.kind, Fault::Kind::Busy);
  EXPECT_THAT(fault.sentence, testing::HasSubstr("already processing"));
}

TEST(Hindrance, IsAbsentForANewerVersion) {
  for (const char* version : {"0.2.1", "0.3.0-rc.1", "1.0.0"}) {
    EXPECT_EQ(refusal_reason({"adit-qemu-virt", version}, kRunning, false), "") << version;
  }
}

TEST(Hindrance, IsAnotherBoard) {
  EXPECT_EQ(refusal_reason({"adit-generic-x86_64", "0.3.0"}, kRunning, true),
            R"(the update is for another board: "adit-generic-x86_64", but this board is "adit-qemu-virt")");
  EXPECT_THAT(refusal_reason({"", "0.3.0"}, kRunning, true), HasSubstr("another board"));
}

TEST(Hindrance, IsAnOlderVersionEvenIfConfirmed) {
  for (const char* version : {"0.1.9", "0.2.0-rc.1", "0.0.1"}) {
    EXPECT_EQ(refusal_reason({"adit-qemu-virt", version}, kRunning, true),
              "the update is older (" + std::string(version) + ") than the running version (0.2.0)");
  }
}

TEST(Hindrance, IsTheSameVersionUnlessConfirmed) {
  EXPECT_EQ(refusal_reason({"adit-qemu-virt", "0.2.0"}, kRunning, false),
            "0.2.0 is already running: confirm to install it again");
  EXPECT_EQ(refusal_reason({"adit-qemu-virt", "0.2.0"}, kRunning, true), "");
}

TEST(Hindrance, IsAnIncomparableVersion) {
  EXPECT_THAT(refusal_reason({"adit-qemu-virt", "newest"}, kRunning, true),
              HasSubstr("cannot read the update's version"));
  RunningSystem unknown = kRunning;
  unknown.version = "";
  EXPECT_THAT(refusal_reason({"adit-qemu-virt", "9.0.0"}, unknown, true),
              HasSubstr("cannot read the running version"));
}

TEST(BundleName, HasThePrefixAndSuffixOfUpdates) {
  EXPECT_TRUE(is_bundle_name("adit-qemu-virt-0.2.0.raucb"));
  EXPECT_TRUE(is_bundle_name("adit-.raucb"));
  for (const char* other :
       {"", "adit-", ".raucb", "adit-x.raucb.part", "ADIT-X.RAUCB", "other.raucb", "adit.raucb"}) {
    EXPECT_FALSE(is_bundle_name(other)) << other;
  }
}

TEST(BundleName, IsVisibleAsciiAndSpaces) {
  EXPECT_TRUE(is_plain("adit-x 1.0.0 (copy)~.raucb"));
  for (const char* other : {"adit-\xe4.raucb", "adit-\xc3\xa4.raucb", "adit-\n.raucb", "adit-\x7f.raucb"}) {
    EXPECT_FALSE(is_plain(other)) << other;
  }
}

TEST(BundleName, PrefersNewerVersionsForThisBoard) {
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

TEST(BundleName, HasNoVersionForABoardWithTheSamePrefix) {
  EXPECT_EQ(promise_of("adit-rock-pi-e-9.0.0.raucb", "adit-rock-pi").version, std::nullopt);
  EXPECT_FALSE(promise_of("adit-rock-pies.raucb", "adit-rock-pi").for_this_board);
  EXPECT_FALSE(promise_of("adit-rock-pi.raucb", "adit-rock-pi").for_this_board);
  EXPECT_FALSE(promise_of("", "adit-rock-pi").for_this_board);
}

}  // namespace
}  // namespace adit::update
