#include "admin/spare.hpp"

#include <gmock/gmock.h>

#include <optional>

#include "admin/settings_of_a_box.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"
#include "ledger/ledger.hpp"
#include "spare/code.hpp"
#include "spare/sealed.hpp"

namespace adit::admin {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

/// A box in its lives: restart() is the end of one gateway and the begin of the next.
class Box {
 public:
  Box() {
    given_.put("settings.json", kSettings);
    restart();
  }

  void restart() {
    restarts = 0;
    spare_.emplace(loop_, workers_, taking_over_, state_.path(), stick_.path(), trouble,
                   Spare::Asked{.content = [] { return content(); }, .restart = [this] { ++restarts; }});
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
  /// What adit-spare says, and what it is asked: the name of a file, and what is to be in it.
  void say(const spare::StickStatus& status) const {
    ASSERT_TRUE(host::write_file(stick_ / spare::kStickStatusFile, spare::write_message(status), 0644));
  }
  spare::StickRequest asked_of_stick() const {
    return *spare::read_message<spare::StickRequest>(*host::read_file(state_ / spare::kStickRequestFile));
  }
  std::pair<std::string, std::string> for_stick() const {
    return {asked_of_stick().name, *host::read_file(state_ / spare::kForStickFile)};
  }
  void read_from_stick(const std::string& file) {
    stick_.put(spare::kFromStickFile, file);
    say({.nonce = asked_of_stick().nonce});
    while (!spare_->spare().stick->doing.empty()) loop_.turn(100ms);
  }
  Spare& spare() { return *spare_; }
  /// Once the loop has done what was to be done at once.
  Box& turned() {
    loop_.turn(10ms);
    return *this;
  }

  std::string trouble;
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

  host::Folder given_, state_, runtime_, stick_;
  loop::Loop loop_;
  loop::Workers workers_{loop_, 1};
  Store store_{given_ / "settings.json", given_.path(), state_.path()};
  TakingOver taking_over_{store_, state_.path(), runtime_.path()};
  std::optional<Spare> spare_;
};

std::string why(const icd::Checked<void>& done) {
  return done ? "" : done.error().sentence;
}

TEST(SpareBox, IsExportedOnlyOnceItRests) {
  Box box;
  EXPECT_THAT(box.exported().error().sentence, HasSubstr("does not rest"));
  ASSERT_TRUE(box.spare().rest());
  EXPECT_EQ(box.turned().restarts, 1);
  EXPECT_EQ(box.spare().rests(), "") << "what is under way ends first";
  box.restart();
  EXPECT_THAT(box.spare().rests(), HasSubstr("put to rest"));
  EXPECT_EQ(box.spare().spare().code.size(), 19U);
  EXPECT_TRUE(box.exported());
}

TEST(SpareBox, GoesOnRestingUntilItIsWokenUp) {
  Box box;
  ASSERT_TRUE(box.spare().rest());
  for (int life = 0; life < 3; ++life) {
    box.restart();
    EXPECT_NE(box.spare().rests(), "");
  }
  ASSERT_TRUE(box.spare().wake());
  box.restart();
  EXPECT_EQ(box.spare().rests(), "");
  EXPECT_EQ(why(box.spare().wake()), "this box does not rest");
}

TEST(SpareBox, AnotherRestHasAnotherCode) {
  Box box;
  ASSERT_TRUE(box.spare().rest());
  box.restart();
  const std::string first = box.spare().spare().code;
  ASSERT_TRUE(box.spare().wake());
  box.restart();
  ASSERT_TRUE(box.spare().rest());
  box.restart();
  EXPECT_NE(box.spare().spare().code, first);
}

TEST(SpareBox, ASpareTakesInWhatItsCodeOpens) {
  Box first, second;
  ASSERT_TRUE(first.spare().rest());
  first.restart();
  const auto file = first.exported();
  ASSERT_TRUE(file);
  EXPECT_EQ(why(second.opened("1234567890123456")), "no export waits for its code: take one in first");
  ASSERT_TRUE(second.spare().take_in(*file));
  EXPECT_TRUE(second.spare().spare().asks_code);
  EXPECT_EQ(why(second.opened("12")), "code: expected 16 digits");
  EXPECT_THAT(why(second.opened("1234567890123456")), HasSubstr("not that of this export"));
  EXPECT_TRUE(second.spare().spare().asks_code) << "it may be typed again";
  EXPECT_EQ(why(second.spare().take_over()), "nothing is taken in: take in the export first");
  ASSERT_TRUE(second.opened(first.spare().spare().code));
  EXPECT_EQ(second.spare().spare().taken_in->name, "192.168.7.11");
  EXPECT_EQ(second.turned().restarts, 0) << "nothing has changed yet";
  ASSERT_TRUE(second.spare().take_over());
  EXPECT_EQ(second.turned().restarts, 1);
  EXPECT_EQ(why(second.spare().rest()), "this box is taking over just now");
}

TEST(SpareBox, IsExportedToTheStickOnlyOnceItRests) {
  Box box;
  box.say({});
  EXPECT_THAT(why(box.to_stick()), HasSubstr("does not rest"));
  ASSERT_TRUE(box.spare().rest());
  box.restart();
  ASSERT_TRUE(box.to_stick());
  EXPECT_THAT(box.for_stick().first,
              testing::MatchesRegex("adit-192\\.168\\.7\\.11-[0-9]{8}T[0-9]{6}Z\\.adit-spare"));
  const auto content = spare::unseal(box.for_stick().second, *spare::code_in(box.spare().spare().code));
  ASSERT_TRUE(content) << content.error();
  EXPECT_EQ(spare::read(*content)->about.name, "192.168.7.11");
}

TEST(SpareBox, TakesInWhatIsReadFromTheStickLikeWhatIsUploaded) {
  Box first, second;
  ASSERT_TRUE(first.spare().rest());
  first.restart();
  second.say({.exports = {"a.adit-spare"}});
  ASSERT_TRUE(second.spare().take_from_stick("a.adit-spare"));
  EXPECT_FALSE(second.spare().spare().asks_code);
  second.read_from_stick(*first.exported());
  EXPECT_TRUE(second.spare().spare().asks_code);
  ASSERT_TRUE(second.opened(first.spare().spare().code));
  ASSERT_TRUE(second.spare().take_over());
  EXPECT_EQ(why(second.spare().take_from_stick("a.adit-spare")), "this box is taking over just now");
}

TEST(SpareBox, DoesNotTakeOverFromItself) {
  Box box;
  ASSERT_TRUE(box.spare().rest());
  box.restart();
  ASSERT_TRUE(box.spare().take_in(*box.exported()));
  EXPECT_THAT(why(box.opened(box.spare().spare().code)), HasSubstr("this box made the export itself"));
}

TEST(SpareBox, RestsWhereItCouldNotTakeOverYet) {
  Box box;
  box.trouble = "no space left";
  box.restart();
  EXPECT_EQ(box.spare().rests(), "it could not take over yet: no space left");
  EXPECT_THAT(box.exported().error().sentence, HasSubstr("does not rest"))
      << "it has nothing whole to hand on";
}

TEST(SpareFile, NamesWhatWasTakenOverFromBefore) {
  const SpareFile file{.box = "own", .rest = std::nullopt, .taken = {{.box = "other", .at = 100}}};
  EXPECT_EQ(file.hindrance("other", 101), "");
  EXPECT_EQ(file.hindrance("third", 1), "");
  EXPECT_THAT(file.hindrance("other", 100), HasSubstr("took over from this export already"));
  EXPECT_THAT(file.hindrance("other", 99), HasSubstr("a later export of that box already"));
}

}  // namespace
}  // namespace adit::admin
