#include <gmock/gmock.h>

#include <filesystem>

#include "applier/clock_setter.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"

namespace adit::applier {
namespace {

namespace fs = std::filesystem;
using clock::Source;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kAsker = "0123456789abcdef0123456789abcdef";

class ClockSetterTest : public testing::Test {
 protected:
  ClockSetterTest() {
    for (const char* name : {"wanted", "status", "chip"}) fs::create_directory(folder / name);
    options.wanted = folder / "wanted";
    options.status = folder / "status";
    options.chip = folder / "chip";
    options.systemctl = folder / "systemctl";
    have_systemctl("echo \"$*\" >>" + (folder / "orders"));
  }
  void have_systemctl(const std::string& what) {
    folder.put("systemctl", "#!/bin/sh\n" + what + '\n');
    fs::permissions(folder / "systemctl", fs::perms::owner_all);
  }
  void ask(const clock::Ntp& ntp) { folder.put("wanted/ntp.json", codec::write_file(ntp)); }
  /// The orders to systemd since the last call.
  std::string orders() {
    const std::string all = host::read_file(folder / "orders").value_or("");
    fs::remove(folder / "orders");
    return all;
  }
  std::string chrony(const char* name) { return host::read_file(folder / "status/" + name).value_or(""); }
  void ask(double time, double at, Source source = Source::Operator, const std::string& server = "") {
    folder.put(
        "wanted/clock.json",
        codec::write_file(clock::Request{
            .nonce = kAsker, .source = source, .time = time, .at = at, .boot = boot, .server = server}));
  }
  clock::Status work() {
    const auto done = ClockSetter(options, {.wall = [this] { return wall; },
                                            .monotonic = [] { return 100.0; },
                                            .set = [this](double time) -> std::expected<void, std::string> {
                                              if (!trouble.empty()) return std::unexpected(trouble);
                                              set.push_back(time);
                                              return {};
                                            },
                                            .set_chip = [this](double time) { chip.push_back(time); },
                                            .boot = boot})
                          .work();
    EXPECT_TRUE(done) << done.error();
    EXPECT_TRUE(fs::is_empty(options.wanted));
    const auto told = codec::read_file<clock::Status>(*host::read_file(folder / "status/status.json"));
    return told.value_or(clock::Status{});
  }

  host::Folder folder;
  ClockOptions options;
  double wall = 1.79e9;
  std::string trouble, boot = "b";
  std::vector<double> set, chip;
};

TEST_F(ClockSetterTest, AddsTheTimeSinceTheRequest) {
  ask(1.8e9, 97.5);
  EXPECT_EQ(work(),
            (clock::Status{.boot = boot, .nonce = kAsker, .refusal = "", .source = Source::Operator}));
  EXPECT_THAT(set, ElementsAre(1.8e9 + 2.5));
}

TEST_F(ClockSetterTest, RejectsOldAndInvalidRequests) {
  ask(1e9, 97.5);
  EXPECT_THAT(work().refusal, HasSubstr("time:"));
  ask(1.8e9, 5);
  EXPECT_THAT(work().refusal, HasSubstr("at:"));
  folder.put("wanted/clock.json", "1800000000");
  work();
  fs::create_symlink("/dev/zero", folder / "wanted/clock.json");
  work();
  EXPECT_THAT(set, IsEmpty());
}

TEST_F(ClockSetterTest, RejectsARequestOfAnotherBoot) {
  ask(1.8e9, 97.5);
  boot = "c";
  const clock::Status told = work();
  EXPECT_THAT(told.refusal, HasSubstr("boot:"));
  EXPECT_EQ(told.boot, "c") << "so that this boot's process requests it again";
  EXPECT_THAT(set, IsEmpty());
}

TEST_F(ClockSetterTest, TellsWhyItFailed) {
  trouble = "Operation not permitted";
  ask(1.8e9, 97.5);
  const clock::Status told = work();
  EXPECT_THAT(told.refusal, HasSubstr(trouble));
  EXPECT_EQ(told.source, Source::None) << "the chip's clock is not set";
}

TEST_F(ClockSetterTest, RecognizesAChipThatAgreesWithTheClock) {
  EXPECT_EQ(work().source, Source::None);
  fs::remove(folder / "status/status.json");
  folder.put("chip/since_epoch", "1500000000\n");
  EXPECT_EQ(work().source, Source::None) << "the chip's battery is empty";
  fs::remove(folder / "status/status.json");
  folder.put("chip/since_epoch", "1790000001\n");
  EXPECT_EQ(work().source, Source::Chip);
  fs::remove(folder / "status/status.json");
  folder.put("chip/since_epoch", "4200000000\n");
  wall = 4.2e9;
  EXPECT_EQ(work().source, Source::None) << "in 2103";
}

TEST_F(ClockSetterTest, WritesNoGuessToTheChip) {
  for (const Source guess : {Source::LastKnown, Source::Robots}) {
    ask(1.8e9, 99, guess);
    work();
  }
  EXPECT_THAT(set, ElementsAre(1.8e9 + 1, 1.8e9 + 1));
  EXPECT_THAT(chip, IsEmpty()) << "the next start would take the time for the chip's";
  for (const Source known : {Source::CommandPost, Source::Operator, Source::Ntp}) {
    ask(1.8e9, 99, known);
    work();
  }
  EXPECT_THAT(chip, ElementsAre(1.8e9 + 1, 1.8e9 + 1, 1.8e9 + 1));
}

TEST_F(ClockSetterTest, LeavesTheChipIfTheClockCannotBeSet) {
  trouble = "Operation not permitted";
  ask(1.8e9, 99);
  work();
  EXPECT_THAT(chip, IsEmpty());
}

TEST_F(ClockSetterTest, LetsChronydSetTheClockOnceItsTimeWasAccepted) {
  ask({.server = "10.0.0.5", .clients = ""});
  EXPECT_EQ(work().ntp.server, "10.0.0.5");
  EXPECT_EQ(orders(), "restart adit-ntp.service\n");
  EXPECT_EQ(chrony("chrony.options"), "CHRONYD=-x\n");
  ask(1.8e9, 99, Source::Ntp, "10.0.0.5");
  EXPECT_EQ(work().source, Source::Ntp);
  EXPECT_THAT(set, ElementsAre(1.8e9 + 1)) << "with the same limits as other times";
  EXPECT_EQ(orders(), "restart adit-ntp.service\n");
  EXPECT_EQ(chrony("chrony.options"), "CHRONYD=\n");
  ask({.server = "10.0.0.5", .clients = ""});
  work();
  EXPECT_EQ(orders(), "") << "the configuration did not change";
  ask(1.8e9, 99, Source::Operator);
  work();
  EXPECT_EQ(chrony("chrony.options"), "CHRONYD=-x\n") << "otherwise chronyd would set the clock back";
  EXPECT_EQ(orders(), "restart adit-ntp.service\n");
}

TEST_F(ClockSetterTest, LetsChronydOnlyMeasureANewServer) {
  ask({.server = "10.0.0.5", .clients = ""});
  ask(1.8e9, 99, Source::Ntp, "10.0.0.5");
  EXPECT_EQ(work().server, "10.0.0.5");
  ask({.server = "10.0.0.6", .clients = ""});
  work();
  EXPECT_EQ(chrony("chrony.options"), "CHRONYD=-x\n") << "chronyd's first time may be an hour off";
  ask(1.7999e9, 99, Source::Ntp, "10.0.0.5");
  EXPECT_THAT(work().refusal, HasSubstr("server:"));
  ask(1.7999e9, 99, Source::Ntp, "10.0.0.6");
  EXPECT_EQ(work().server, "10.0.0.6");
  EXPECT_EQ(chrony("chrony.options"), "CHRONYD=\n");
}

TEST_F(ClockSetterTest, LetsChronydServeTheTimeOnceSet) {
  ask({.server = "", .clients = "10.0.0.0/24"});
  work();
  EXPECT_THAT(chrony("chrony.conf"), HasSubstr("port 0"));
  ask(1.8e9, 99, Source::CommandPost);
  work();
  EXPECT_THAT(chrony("chrony.conf"), HasSubstr("local stratum 10"));
  EXPECT_EQ(orders(), "restart adit-ntp.service\nrestart adit-ntp.service\n");
}

TEST_F(ClockSetterTest, StopsOnlyItsOwnChronyd) {
  ask(clock::Ntp{});
  work();
  EXPECT_EQ(orders(), "");
  ask({.server = "10.0.0.5", .clients = ""});
  work();
  ask(clock::Ntp{});
  EXPECT_EQ(work().ntp, clock::Ntp{});
  EXPECT_EQ(orders(), "restart adit-ntp.service\nstop adit-ntp.service\n");
  EXPECT_FALSE(fs::exists(folder / "status/chrony.conf"));
}

TEST_F(ClockSetterTest, TellsWhyChronydFailsAndRetriesOnRequest) {
  have_systemctl("echo not found >&2; exit 5");
  ask({.server = "10.0.0.5", .clients = ""});
  EXPECT_THAT(work().trouble, HasSubstr("not found"));
  have_systemctl("true");
  ask({.server = "10.0.0.5", .clients = ""});
  EXPECT_EQ(work().trouble, "");
}

TEST_F(ClockSetterTest, RejectsInvalidNtpSettings) {
  for (const char* text : {"{}", "null", R"({"format":1,"server":"10.0.0.5\nallow","clients":""})"}) {
    folder.put("wanted/ntp.json", text);
    EXPECT_EQ(work().ntp, clock::Ntp{}) << text;
  }
  EXPECT_EQ(orders(), "");
}

TEST_F(ClockSetterTest, RemembersTheSourceUntilTheNextBoot) {
  ask(1.8e9, 99, Source::CommandPost);
  work();
  EXPECT_EQ(work().source, Source::CommandPost);
}

}  // namespace
}  // namespace adit::applier
