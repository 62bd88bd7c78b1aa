#include "admin/takeover.hpp"

#include <gmock/gmock.h>

#include <filesystem>

#include "admin/settings_of_a_box.hpp"
#include "forward/clocks.hpp"
#include "host/folder.hpp"
#include "ledger/ledger.hpp"

namespace adit::admin {
namespace {

using testing::HasSubstr;
using testing::SizeIs;
namespace fs = std::filesystem;

dispatch::Report answered(std::int64_t number) {
  dispatch::Report report{
      .number = number, .sender = "10.0.0.7", .received = 10.0 + static_cast<double>(number)};
  report.report = {"Backpack", {1, 2, 3}};
  report.run = 1;
  report.state = dispatch::ReportState::Answered;
  return report;
}

constexpr const char* kFirstBoxPem =
    "-----BEGIN PRIVATE KEY-----\nc2VjcmV0\n-----END PRIVATE KEY-----\n"
    "-----BEGIN CERTIFICATE-----\nYWRpdA==\n-----END CERTIFICATE-----\n";

class TakeoverTest : public testing::Test {
 protected:
  TakeoverTest() { given_.put("settings.json", kSettings); }

  spare::Content content(std::size_t reports = 2) const {
    const host::Folder folder;
    auto ledger = ledger::Ledger::open(folder.path());
    for (std::size_t i = 1; ledger && i <= reports; ++i) {
      const dispatch::Report report = answered(static_cast<std::int64_t>(i));
      EXPECT_TRUE(ledger->write({&report, 1}));
    }
    spare::Content content;
    content.about = {.box = "0123456789abcdef", .name = "192.168.7.11", .version = "1.0.0", .at = 100};
    content.about.stamps = 9e9 / 2;
    content.settings = kSettings;
    content.tokens.emplace("scoring", *icd::BearerToken::parse("the-first-box-s"));
    content.tokens.emplace("../../escaped", *icd::BearerToken::parse("of-no-name"));
    content.ledger = *ledger->copy();
    content.certificate = kFirstBoxPem;
    return content;
  }
  std::vector<dispatch::Report> reports() const {
    const auto ledger = ledger::Ledger::open(state_.path());
    return ledger ? ledger->reports() : std::vector<dispatch::Report>();
  }

  host::Folder given_, state_;
  Store store_{given_ / "settings.json", given_.path(), state_.path()};
  const std::string memory_ = given_ / "ledger-on-disk";
  Takeover takeover_{store_, state_.path(), memory_};
  loop::Loop loop_;
};

TEST_F(TakeoverTest, DoesNothingUnlessBegun) {
  EXPECT_EQ(takeover_.finish(loop_), false);
  EXPECT_FALSE(fs::exists(state_ / "ledger"));
}

TEST_F(TakeoverTest, ImportsReportsSettingsTokensAndStampsOnce) {
  store_.save_token("mapping", icd::BearerToken::parse("the-spare-s-own"));
  ASSERT_TRUE(takeover_.begin(spare::write(content())));
  EXPECT_FALSE(fs::exists(state_ / "ledger")) << "a ledger in use was changed";
  ASSERT_EQ(takeover_.finish(loop_), true);
  EXPECT_THAT(reports(), SizeIs(2));
  const auto loaded = store_.load();
  ASSERT_TRUE(loaded);
  EXPECT_TRUE(loaded->saved);
  EXPECT_EQ(loaded->secrets.token("scoring")->reveal(), "the-first-box-s");
  EXPECT_FALSE(loaded->secrets.token("mapping")) << "the first box had no token";
  EXPECT_EQ(host::read_file(state_ / "tls.pem"), kFirstBoxPem) << "browsers know the first box's certificate";
  EXPECT_EQ(forward::StampFloor(state_.path()).read()->least, 9e9 / 2);
  EXPECT_EQ(SpareFile::read(state_.path())->taken.at(0).at, 100);
  EXPECT_EQ(takeover_.finish(loop_), false);
  EXPECT_FALSE(fs::exists(state_ / "../../escaped.token"));
}

TEST_F(TakeoverTest, KeepsTheOwnCertificateIfTheFirstBoxHadNone) {
  state_.put("tls.pem", "its own");
  spare::Content other = content();
  other.certificate.clear();
  ASSERT_TRUE(takeover_.begin(spare::write(other)));
  ASSERT_EQ(takeover_.finish(loop_), true);
  EXPECT_EQ(host::read_file(state_ / "tls.pem"), "its own");
}

TEST_F(TakeoverTest, RejectsADamagedCertificate) {
  spare::Content other = content();
  other.certificate = "torn";
  EXPECT_THAT(takeover_.check(other).error(), HasSubstr("cannot use the export's certificate"));
}

TEST_F(TakeoverTest, RecordsTheSizeOfTheOldLedger) {
  const dispatch::Report report = answered(1);
  auto here = ledger::Ledger::open(state_.path());
  ASSERT_TRUE(here->write({&report, 1}));
  forward::StampFloor(state_.path()).write({.floor = 1, .ledger = here->known_facts()});
  here = std::unexpected(ledger::Error());  // the ledger is closed
  ASSERT_TRUE(takeover_.begin(spare::write(content())));
  ASSERT_EQ(takeover_.finish(loop_), true);
  const auto kept = forward::StampFloor(state_.path()).read();
  EXPECT_EQ(kept->ledger.reports, 1);
  EXPECT_EQ(kept->ledger.log, 1U);
}

TEST_F(TakeoverTest, FindsAnOlderCopyOfTheLedger) {
  const fs::path ledger = state_ / "ledger", older = given_ / "older";
  for (const std::int64_t number : {1, 2}) {
    const dispatch::Report report = answered(number);
    ASSERT_TRUE(ledger::Ledger::open(state_.path(), {}, memory_)->write({&report, 1}));
    if (number == 1) fs::copy(ledger, older, fs::copy_options::recursive);
  }
  fs::remove_all(ledger);
  fs::rename(older, ledger);
  ASSERT_TRUE(takeover_.begin(spare::write(content(1))));
  ASSERT_EQ(takeover_.finish(loop_), true);
  EXPECT_THAT(reports(), testing::Contains(testing::Property(&dispatch::Report::is_lost, true)));
}

TEST_F(TakeoverTest, RepeatsAfterAPowerCut) {
  const std::string text = spare::write(content());
  for (int cut = 0; cut < 3; ++cut) {
    ASSERT_TRUE(takeover_.begin(text));
    ASSERT_EQ(takeover_.finish(loop_), true);
    EXPECT_THAT(reports(), SizeIs(2));
  }
}

TEST_F(TakeoverTest, EndsStandby) {
  ASSERT_TRUE((SpareFile{.box = "b", .rest = Standby{.code = "1", .since = 5}}.write(state_.path())));
  ASSERT_TRUE(takeover_.begin(spare::write(content())));
  ASSERT_EQ(takeover_.finish(loop_), true);
  EXPECT_FALSE(SpareFile::read(state_.path())->rest);
}

TEST_F(TakeoverTest, RejectsAnInvalidLedger) {
  spare::Content other = content();
  other.ledger = "no ledger";
  ASSERT_TRUE(takeover_.begin(spare::write(other)));
  const auto done = takeover_.finish(loop_);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error(), HasSubstr("ledger"));
  EXPECT_TRUE(fs::exists(state_ / "take-over")) << "a failed take-over is tried again";
  ASSERT_TRUE(takeover_.abandon());
  EXPECT_EQ(takeover_.finish(loop_), false);
}

TEST_F(TakeoverTest, FailsWhileUsedExportsCannotBeRead) {
  ASSERT_TRUE(takeover_.begin(spare::write(content())));
  fs::create_directory(fs::path(state_.path()) / SpareFile::kName);
  EXPECT_FALSE(takeover_.finish(loop_));
  fs::remove(fs::path(state_.path()) / SpareFile::kName);
  EXPECT_EQ(takeover_.finish(loop_), true);
  EXPECT_THAT(reports(), SizeIs(2));
}

/// The age of the Command Post's last status includes the swap only if both clocks are set. Silence that no
/// box saw must not look like a new run.
TEST_F(TakeoverTest, CountsTheSwapTimeOnlyIfBothClocksAreSet) {
  for (const bool are_told : {false, true}) {
    const host::Folder folder;
    auto there = ledger::Ledger::open(folder.path());
    ASSERT_TRUE(there->write(dispatch::Run{.number = 1, .last = icd::RunStatus{}, .heard = 990}));
    spare::Content content = this->content();
    content.ledger = *there->copy();
    content.about.at = loop_.wall_now() - 5000;
    content.about.stamp = 1000;
    if (are_told) content.about.told_at = content.about.at;
    ASSERT_TRUE(takeover_.begin(spare::write(content)));
    ASSERT_EQ(takeover_.finish(loop_), true);
    const double stamp =
        forward::StampFloor(state_.path()).read()->least;  // ahead of the clock, like all stamps
    const auto runs = ledger::Ledger::open(state_.path())->runs();
    ASSERT_THAT(runs, SizeIs(1));
    EXPECT_NEAR(stamp - runs.at(0).heard, are_told ? 5010 : 10, 2);
    fs::remove_all(state_ / "ledger");
  }
}

TEST_F(TakeoverTest, FailsWhileStampsCannotBeRead) {
  const std::string file = state_ / forward::StampFloor::kFile;
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  ASSERT_TRUE(takeover_.begin(spare::write(content())));
  EXPECT_EQ(takeover_.finish(loop_).error(), file + ": is not a regular file");
  EXPECT_TRUE(fs::is_fifo(file));
}

TEST_F(TakeoverTest, TellsWhyItsRequestCannotBeRead) {
  fs::create_directory(state_ / Takeover::kFile);
  EXPECT_FALSE(takeover_.finish(loop_));
  EXPECT_EQ(takeover_.unread(), (state_ / Takeover::kFile) + ": is not a regular file");
}

TEST_F(TakeoverTest, FailsWhileSettingsOfThisMachineCannotBeRead) {
  given_.put("settings.json", "damaged");
  ASSERT_TRUE(takeover_.begin(spare::write(content())));
  const auto done = takeover_.finish(loop_);
  ASSERT_FALSE(done) << "this machine's interfaces would be lost";
  EXPECT_THAT(done.error(), HasSubstr(given_ / "settings.json"));
  given_.put("settings.json", kSettings);
  EXPECT_EQ(takeover_.finish(loop_), true);
}

TEST_F(TakeoverTest, KeepsSettingsOfThisMachine) {
  spare::Content other = content();
  other.settings =
      R"({"version":1,"command_post":{"scoring":{"address":"10.100.2.200","port":8000},)"
      R"("mapping":{"address":"10.100.2.201","port":8000},"interface":"enp3s0"},)"
      R"("team":{"interface":"enp4s0","listen":[{"address":"10.9.9.9","port":80},{"address":"fd00::1","port":80},)"
      R"({"address":"0.0.0.0","port":80}]},)"
      R"("panel":{"chip":"gpiochip0","health":"H"}})";
  ASSERT_TRUE(takeover_.begin(spare::write(other)));
  ASSERT_EQ(takeover_.finish(loop_), true);
  const auto settings = store_.load()->settings;
  EXPECT_EQ(settings.command_post.scoring.address, "10.100.2.200") << "the first box's address";
  EXPECT_EQ(settings.command_post.interface, "darpa0");
  EXPECT_EQ(settings.team.interface, "team0");
  EXPECT_THAT(settings.team.listen,
              testing::ElementsAre(settings::Address{"0.0.0.0", 80}, settings::Address{"::", 80}))
      << "the first box's ports at existing addresses";
  EXPECT_TRUE(settings.panel.is_simulated());
}

/// The settings of this box and of the first one, without a team interface.
class WithoutTeamInterfaceTest : public TakeoverTest {
 protected:
  static std::string settings(const std::string& command_post, const std::string& listen) {
    return R"({"version":1,"command_post":{"scoring":{"address":"127.0.0.1","port":)" + command_post +
           R"(},"mapping":{"address":"127.0.0.1","port":9001}},"team":{"listen":[)" + listen + "]}}";
  }
  void begin(const std::string& of_the_first) {
    given_.put("settings.json", settings("9000", R"({"address":"127.0.0.1","port":8001},)"
                                                 R"({"address":"127.0.0.1","port":8002},)"
                                                 R"({"address":"::1","port":8001})"));
    spare::Content other = content();
    other.settings = of_the_first;
    ASSERT_TRUE(takeover_.begin(spare::write(other)));
  }
};

TEST_F(WithoutTeamInterfaceTest, ListensAtOwnAddressesWithTheOtherBoxsPorts) {
  begin(settings("9000", R"({"address":"10.9.9.9","port":80})"));
  ASSERT_EQ(takeover_.finish(loop_), true);
  EXPECT_THAT(store_.load()->settings.team.listen,
              testing::ElementsAre(settings::Address{"127.0.0.1", 80}, settings::Address{"::1", 80}))
      << "with an address of the first box, aditd would not start and would revert to its own settings";
}

TEST_F(WithoutTeamInterfaceTest, RejectsSettingsThatPostToItself) {
  begin(settings("8000", R"({"address":"10.9.9.9","port":8000})"));
  const auto done = takeover_.finish(loop_);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error(), HasSubstr("the two boxes' settings do not fit: team.listen[0]"));
  EXPECT_EQ(store_.load()->settings.team.listen.front().port, 8001);
}

TEST_F(TakeoverTest, NamesOmittedSettings) {
  spare::Content other = content();
  other.settings.insert(other.settings.find("\"version\""), "\"later\": 1, ");
  EXPECT_EQ(takeover_.check(other)->passed_over, std::vector<std::string>{"later"});
}

TEST_F(TakeoverTest, RejectsUnusableSettings) {
  spare::Content other = content();
  other.settings = R"({"version": 9})";
  const auto checked = takeover_.check(other);
  ASSERT_FALSE(checked);
  EXPECT_THAT(checked.error(), HasSubstr("this box cannot use the export's settings"));
  EXPECT_TRUE(takeover_.check(content()));
}

}  // namespace
}  // namespace adit::admin
