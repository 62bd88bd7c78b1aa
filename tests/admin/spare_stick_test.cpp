#include <gmock/gmock.h>

#include "admin/spare.hpp"
#include "host/folder.hpp"
#include "host/service.hpp"
#include "loop/simulated_time.hpp"

namespace adit::admin {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kName = "adit-10.0.0.1-20261123T231600Z.adit-spare";
constexpr double kAt = 1795475760;

class SpareStickTest : public testing::Test {
 protected:
  void write_status(const spare::StickStatus& status) {
    ASSERT_TRUE(host::write_file(run_ / host::kStatusFile, codec::write_file(status), 0644));
    time_.pass(host::kFresh);
  }
  std::optional<spare::StickRequest> asked() const {
    const auto text = host::read_file(state_ / spare::kStickRequestFile);
    const auto request = text ? codec::read_file<spare::StickRequest>(*text) : std::unexpected(text.error());
    return request ? std::optional(*request) : std::nullopt;
  }
  /// Removes the request as adit-spare does, and writes that status.
  void answer(spare::StickStatus status) {
    status.nonce = asked()->nonce;
    ASSERT_TRUE(host::remove_file(state_ / spare::kStickRequestFile));
    write_status(status);
    if (status.doing.empty()) EXPECT_TRUE(is_over());
  }
  bool is_over() {
    return time_.pass_until(loop_, [this] { return stick_.view()->doing.empty(); }, std::chrono::seconds(10));
  }
  static std::string why(const icd::Checked<void>& done) { return done ? "" : done.error().sentence; }

  host::Folder state_, run_;
  loop::SimulatedTime time_;
  loop::Loop loop_;
  std::vector<std::string> taken_;
  SpareStick stick_{loop_, state_.path(), run_.path(),
                    [this](std::string file) { taken_.push_back(std::move(file)); }};
};

TEST_F(SpareStickTest, IsAbsentIfAditSpareDoesNotRun) {
  EXPECT_FALSE(stick_.view());
  for (const auto& refused : {stick_.write(kName, "x"), stick_.request_import(kName)})
    EXPECT_THAT(why(refused), HasSubstr("adit-spare does not run"));
  EXPECT_FALSE(asked());
}

TEST_F(SpareStickTest, ListsExportsByTheirFileNames) {
  write_status({.hindrance = "the stick is write-protected", .exports = {kName, "b.adit-spare"}});
  const auto view = stick_.view();
  ASSERT_TRUE(view);
  EXPECT_EQ(view->hindrance, "the stick is write-protected");
  ASSERT_EQ(view->exports.size(), 2U);
  EXPECT_EQ(view->exports[0].box, "10.0.0.1");
  EXPECT_EQ(view->exports[0].at, kAt);
  EXPECT_EQ(view->exports[1].box, "");
}

TEST_F(SpareStickTest, TellsWhyTheStickCannotBeRead) {
  write_status({.unreadable = "cannot read the stick sda1: Input/output error"});
  EXPECT_EQ(stick_.view()->unreadable, "cannot read the stick sda1: Input/output error");
  ASSERT_TRUE(host::write_file(run_ / host::kStatusFile, "damaged", 0644));
  time_.pass(host::kFresh);
  EXPECT_THAT(stick_.view()->unreadable, HasSubstr("cannot read the status of adit-spare"));
}

TEST_F(SpareStickTest, WritesTheFileBeforeTheRequest) {
  write_status({});
  ASSERT_TRUE(stick_.write(kName, "sealed"));
  EXPECT_EQ(host::read_file(state_ / spare::kForStickFile), "sealed");
  EXPECT_EQ(asked()->what, spare::StickRequest::Command::Write);
  EXPECT_EQ(asked()->name, kName);
  EXPECT_EQ(stick_.view()->doing, "writing");
  EXPECT_THAT(why(stick_.request_import(kName)), HasSubstr("the box is already writing"));
  answer({.doing = "checking"});
  EXPECT_EQ(stick_.view()->doing, "checking");
  write_status(
      {.nonce = codec::read_file<spare::StickStatus>(*host::read_file(run_ / host::kStatusFile))->nonce,
       .written = kName});
  EXPECT_TRUE(is_over());
  EXPECT_EQ(stick_.view()->written, kName);
  EXPECT_TRUE(taken_.empty());
}

TEST_F(SpareStickTest, RejectsAWriteThatCannotSucceed) {
  write_status({.hindrance = "there is no stick in the box"});
  EXPECT_EQ(why(stick_.write(kName, "sealed")), "there is no stick in the box");
  EXPECT_FALSE(asked());
}

TEST_F(SpareStickTest, ReturnsTheReadFile) {
  write_status({.exports = {kName}});
  ASSERT_TRUE(stick_.request_import(kName));
  run_.put(spare::kFromStickFile, "sealed");
  answer({.exports = {kName}});
  EXPECT_THAT(taken_, ElementsAre("sealed"));
}

TEST_F(SpareStickTest, TellsWhyARequestFailed) {
  write_status({.exports = {kName}});
  ASSERT_TRUE(stick_.request_import(kName));
  answer({.refusal = "the file is not an export from Adit"});
  EXPECT_EQ(stick_.view()->refusal, "the file is not an export from Adit");
  ASSERT_TRUE(stick_.request_import(kName));
  EXPECT_EQ(stick_.view()->refusal, "") << "the error stays during a retry";
  answer({});
  EXPECT_THAT(stick_.view()->refusal, HasSubstr("No such file")) << "adit-spare wrote no file";
  EXPECT_TRUE(taken_.empty());
}

TEST_F(SpareStickTest, RejectsNamesOutsideTheStick) {
  write_status({});
  for (const char* const name : {"../../etc/shadow", "a/b.adit-spare", "passwd", ""})
    EXPECT_THAT(why(stick_.request_import(name)), HasSubstr("name: expected")) << name;
  EXPECT_FALSE(asked());
}

}  // namespace
}  // namespace adit::admin
