#include "admin/spare.hpp"

#include <gmock/gmock.h>

#include <optional>

#include "admin/settings_of_a_box.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"
#include "ledger/ledger.hpp"
#include "spare/sealed.hpp"

namespace adit::admin {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A box over several gateways: restart() ends one and begins the next.
class Box {
 public:
  Box() {
    given_.put("settings.json", kSettings);
    restart();
  }

  void restart() {
    restarts = 0;
    spare_.emplace(loop_, workers_, takeover_, state_.path(), stick_.path(), trouble,
                   Spare::Callbacks{.content = [] { return content(); },
                                    .is_time_set = [this] { return is_time_set; },
                                    .restart = [this] { ++restarts; }});
  }
  icd::Checked<std::string> exported() {
    std::optional<icd::Checked<std::string>> file;
    spare_->export_to([&file](icd::Checked<std::string> sealed) { file = std::move(sealed); });
    while (!file) loop_.turn(100ms);
    return *std::move(file);
  }
  icd::Checked<void> opened(const std::string& code) {
    std::optional<icd::Checked<void>> done;
    spare_->open(code, [&done](icd::Checked<void> checked) { done = std::move(checked); });
    while (!done) loop_.turn(100ms);
    return *done;
  }
  icd::Checked<void> to_stick() {
    std::optional<icd::Checked<void>> done;
    spare_->export_to_stick([&done](icd::Checked<void> asked) { done = std::move(asked); });
    while (!done) loop_.turn(100ms);
    return *done;
  }
  /// Writes adit-spare's status; reads its requests: the name of a file, and its content.
  void write_status(const spare::StickStatus& status) const {
    ASSERT_TRUE(host::write_file(stick_ / host::kStatusFile, codec::write_file(status), 0644));
  }
  spare::StickRequest asked_of_stick() const {
    return *codec::read_file<spare::StickRequest>(*host::read_file(state_ / spare::kStickRequestFile));
  }
  std::pair<std::string, std::string> stick_request_file() const {
    return {asked_of_stick().name, *host::read_file(state_ / spare::kForStickFile)};
  }
  void read_from_stick(const std::string& file) {
    stick_.put(spare::kFromStickFile, file);
    write_status({.nonce = asked_of_stick().nonce});
    while (!spare_->state().stick->doing.empty()) loop_.turn(100ms);
  }
  Spare& spare() { return *spare_; }
  /// Runs the loop until all immediate events are handled.
  Box& turned() {
    loop_.turn(10ms);
    return *this;
  }

  double stamp() const { return loop_.stamp_now(); }
  const host::Folder& state() const { return state_; }

  std::string trouble;
  bool is_time_set = false;
  int restarts = 0;

 private:
  static std::expected<spare::Content, std::string> content() {
    const host::Folder folder;
    spare::Content content;
    content.settings = kSettings;
    content.about.name = "192.168.7.11";
    content.ledger = *ledger::Ledger::open(folder.path())->copy();
    return content;
  }

  host::Folder given_, state_, stick_;
  loop::Loop loop_;
  loop::Workers workers_{loop_, 1};
  Store store_{given_ / "settings.json", given_.path(), state_.path()};
  Takeover takeover_{store_, state_.path(), ""};
  std::optional<Spare> spare_;
};

std::string why(const icd::Checked<void>& done) {
  return done ? "" : done.error().sentence;
}

TEST(SpareBox, ExportsOnlyOnStandby) {
  Box box;
  EXPECT_THAT(box.exported().error().sentence, HasSubstr("not on standby"));
  ASSERT_TRUE(box.spare().enter_standby());
  EXPECT_EQ(box.turned().restarts, 1);
  EXPECT_EQ(box.spare().standby(), "") << "standby waits for requests in flight";
  box.restart();
  EXPECT_THAT(box.spare().standby(), HasSubstr("its spare takes over"));
  EXPECT_EQ(box.spare().state().code.size(), 19U);
  EXPECT_TRUE(box.exported());
}

TEST(SpareBox, StaysOnStandbyUntilResumed) {
  Box box;
  ASSERT_TRUE(box.spare().enter_standby());
  for (int life = 0; life < 3; ++life) {
    box.restart();
    EXPECT_NE(box.spare().standby(), "");
  }
  ASSERT_TRUE(box.spare().resume());
  box.restart();
  EXPECT_EQ(box.spare().standby(), "");
  EXPECT_EQ(why(box.spare().resume()), "this box is not on standby");
}

TEST(SpareBox, EachStandbyHasItsOwnCode) {
  Box box;
  ASSERT_TRUE(box.spare().enter_standby());
  box.restart();
  const std::string first = box.spare().state().code;
  ASSERT_TRUE(box.spare().resume());
  box.restart();
  ASSERT_TRUE(box.spare().enter_standby());
  box.restart();
  EXPECT_NE(box.spare().state().code, first);
}

TEST(SpareBox, ImportsTheExportThatItsCodeOpens) {
  Box first, second;
  ASSERT_TRUE(first.spare().enter_standby());
  first.restart();
  const auto file = first.exported();
  ASSERT_TRUE(file);
  EXPECT_EQ(why(second.opened("1234567890123456")), "there is no export to open: import one first");
  ASSERT_TRUE(second.spare().import_file(*file));
  EXPECT_TRUE(second.spare().state().asks_code);
  EXPECT_EQ(why(second.opened("12")), "code: expected 16 digits");
  EXPECT_THAT(why(second.opened("1234567890123456")), HasSubstr("not that of this export"));
  EXPECT_TRUE(second.spare().state().asks_code) << "the code may be typed again";
  EXPECT_EQ(why(second.spare().take_over()), "no export is open: import and open one first");
  ASSERT_TRUE(second.opened(first.spare().state().code));
  EXPECT_EQ(second.spare().state().taken_in->name, "192.168.7.11");
  EXPECT_EQ(second.spare().state().taken_in->port, 8000);
  EXPECT_EQ(second.turned().restarts, 0) << "the box restarted too early";
  ASSERT_TRUE(second.spare().take_over());
  EXPECT_EQ(second.turned().restarts, 1);
  EXPECT_EQ(why(second.spare().enter_standby()), "this box is taking over just now");
}

TEST(SpareBox, ExportsToTheStickOnlyOnStandby) {
  Box box;
  box.write_status({});
  EXPECT_THAT(why(box.to_stick()), HasSubstr("not on standby"));
  ASSERT_TRUE(box.spare().enter_standby());
  box.restart();
  ASSERT_TRUE(box.to_stick());
  EXPECT_THAT(box.stick_request_file().first,
              testing::MatchesRegex("adit-192\\.168\\.7\\.11-[0-9]{8}T[0-9]{6}Z\\.adit-spare"));
  const auto content =
      spare::unseal(box.stick_request_file().second, *spare::code_in(box.spare().state().code));
  ASSERT_TRUE(content) << content.error();
  EXPECT_EQ(spare::read(*content)->about.name, "192.168.7.11");
}

TEST(SpareBox, ImportsFromTheStickLikeAnUpload) {
  Box first, second;
  ASSERT_TRUE(first.spare().enter_standby());
  first.restart();
  second.write_status({.exports = {"a.adit-spare"}});
  ASSERT_TRUE(second.spare().import_from_stick("a.adit-spare"));
  EXPECT_FALSE(second.spare().state().asks_code);
  second.read_from_stick(*first.exported());
  EXPECT_TRUE(second.spare().state().asks_code);
  ASSERT_TRUE(second.opened(first.spare().state().code));
  ASSERT_TRUE(second.spare().take_over());
  EXPECT_EQ(why(second.spare().import_from_stick("a.adit-spare")), "this box is taking over just now");
}

TEST(SpareBox, DoesNotTakeOverFromItself) {
  Box box;
  ASSERT_TRUE(box.spare().enter_standby());
  box.restart();
  ASSERT_TRUE(box.spare().import_file(*box.exported()));
  EXPECT_THAT(why(box.opened(box.spare().state().code)), HasSubstr("this box made the export itself"));
}

TEST(SpareBox, StaysOnStandbyIfTakeOverFails) {
  Box box;
  box.trouble = "the take-over is not finished: no space left";
  box.restart();
  EXPECT_EQ(box.spare().standby(), "the take-over is not finished: no space left");
  EXPECT_THAT(box.exported().error().sentence, HasSubstr("not on standby"))
      << "the box has no complete state to export";
}

TEST(SpareBox, HidesExportsOfAnEarlierStandby) {
  Box box;
  box.write_status({});
  ASSERT_TRUE(box.spare().enter_standby());
  box.restart();
  ASSERT_TRUE(box.to_stick());
  const std::string file = box.stick_request_file().first;
  box.write_status({.nonce = box.asked_of_stick().nonce, .written = file});
  box.restart();
  EXPECT_EQ(box.spare().state().stick->written, file);
  box.write_status({.written = "adit-192.168.7.11-20200101T000000Z.adit-spare"});
  box.restart();
  EXPECT_EQ(box.spare().state().stick->written, "");
  box.write_status({.written = "named-by-hand.adit-spare"});
  box.restart();
  EXPECT_EQ(box.spare().state().stick->written, "");
}

/// The export, opened with its code.
spare::ExportInfo about_of(Box& box) {
  const auto text = spare::unseal(*box.exported(), *spare::code_in(box.spare().state().code));
  return spare::read(*text)->about;
}

TEST(SpareBox, CountsStandbysAndRecordsTheirTimes) {
  Box box;
  for (const std::int64_t count : {1, 2}) {
    ASSERT_TRUE(box.spare().enter_standby());
    const double stamp = box.stamp();
    box.restart();
    const spare::ExportInfo about = about_of(box);
    EXPECT_EQ(about.rest_count, count);
    EXPECT_NEAR(about.stamp, stamp, 1) << "the stamp of standby, not of the export";
    EXPECT_EQ(about.told_at, std::nullopt) << "the time of day was never set";
    ASSERT_TRUE(box.spare().resume());
    box.restart();
  }
  box.is_time_set = true;
  ASSERT_TRUE(box.spare().enter_standby());
  box.is_time_set = false;  // since then
  box.restart();
  EXPECT_EQ(about_of(box).told_at, about_of(box).at);
}

TEST(SpareBox, ResumesWithADamagedButNotAnUnreadableFile) {
  Box box;
  ASSERT_TRUE(box.spare().enter_standby());
  const std::filesystem::path file = box.state() / SpareFile::kName, elsewhere = box.state() / "elsewhere";
  std::filesystem::rename(file, elsewhere);
  std::filesystem::create_directory(file);
  box.restart();
  EXPECT_THAT(why(box.spare().resume()), HasSubstr("spare.json"));
  std::filesystem::remove(file);
  std::filesystem::rename(elsewhere, file);
  box.restart();
  EXPECT_NE(box.spare().standby(), "") << "the box is still on standby";
  box.state().put(SpareFile::kName, "no JSON");
  box.restart();
  EXPECT_TRUE(box.spare().resume());
}

TEST(SpareFile, NamesEarlierTakeOvers) {
  const SpareFile file{.box = "own",
                       .taken = {{.box = "other", .at = 100}, {.box = "counts", .at = 100, .rest_count = 2}}};
  const auto hindrance = [&file](std::string box, double at, std::optional<std::int64_t> count = {}) {
    return file.refusal_reason({.box = std::move(box), .at = at, .rest_count = count});
  };
  EXPECT_EQ(hindrance("other", 101), "");
  EXPECT_EQ(hindrance("third", 1), "");
  EXPECT_THAT(hindrance("other", 100), HasSubstr("already took over from this export"));
  EXPECT_THAT(hindrance("other", 99), HasSubstr("a later export of the same box"));
  EXPECT_EQ(hindrance("counts", 50, 3), "") << "the clock was set back since the export";
  EXPECT_THAT(hindrance("counts", 100, 2), HasSubstr("already took over from this export"));
  EXPECT_THAT(hindrance("counts", 150, 1), HasSubstr("a later export of the same box"));
}

TEST(SpareFile, ReadsFilesOfAnEarlierAdit) {
  const host::Folder folder;
  folder.put(SpareFile::kName, R"({"format":1,"box":"b","rest":{"code":"1","since":5,"expected":null},)"
                               R"("taken":[{"box":"other","at":100}]})");
  const auto file = SpareFile::read(folder.path());
  ASSERT_TRUE(file) << file.error();
  EXPECT_EQ(file->rest->since, 5);
  EXPECT_EQ(file->taken.at(0).rest_count, std::nullopt);
}

}  // namespace
}  // namespace adit::admin
