#include "admin/updates.hpp"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <fstream>

#include "host/folder.hpp"
#include "host/service.hpp"
#include "loop/simulated_time.hpp"
#include "loop/turn_until.hpp"

namespace adit::admin {
namespace {

using namespace std::chrono_literals;
using testing::EndsWith;
using testing::HasSubstr;
using testing::StartsWith;
namespace fs = std::filesystem;

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class UpdatesTest : public testing::Test {
 protected:
  UpdatesTest() { write_status({.running = {"adit-board", "0.1.0", "A", "B"}}); }

  void write_status(const update::Status& status) const {
    ASSERT_TRUE(host::write_file(run_ / host::kStatusFile, codec::write_file(status), 0644));
  }
  /// Waits until the status is too old.
  void wait() { time_.pass(host::kFresh); }
  std::optional<update::Request> asked() const {
    const auto text = host::read_file(state_ / update::kRequestFile);
    const auto request = text ? codec::read_file<update::Request>(*text) : std::unexpected(text.error());
    return request ? std::optional(*request) : std::nullopt;
  }
  /// Sends `bytes` in pieces and returns the result.
  icd::Checked<void> upload(const std::string& bytes, std::uint64_t announced, bool again = false) {
    bool may_go_on = true;
    auto upload = updates_.receive(announced, again, [&may_go_on] { may_go_on = true; });
    if (!upload) return std::unexpected(upload.error());
    constexpr std::size_t kPiece = 100'000;
    for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
      while (!may_go_on) loop_.turn(100ms);
      const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data()) + at;
      may_go_on = (*upload)->write({data, std::min(kPiece, bytes.size() - at)});
    }
    std::optional<icd::Checked<void>> ended;
    (*upload)->finish([&ended](icd::Checked<void> outcome) { ended = std::move(outcome); });
    while (!ended) loop_.turn(100ms);
    return *ended;
  }

  host::Folder state_, run_;
  loop::SimulatedTime time_;
  loop::Loop loop_;
  loop::Writer writer_{loop_};
  std::string under_way_;
  Updates updates_{loop_, writer_, state_.path(), run_.path(), [this] { return under_way_; }};
};

TEST_F(UpdatesTest, DeleteAnInterruptedUploadAtStart) {
  const std::string half = state_.put(std::string(update::kBundleFile) + ".part", "half of a bundle");
  const Updates after(loop_, writer_, state_.path(), run_.path(), [] { return ""; });
  EXPECT_FALSE(fs::exists(half));
}

TEST_F(UpdatesTest, ShowTheStatusOfAditUpdate) {
  write_status({.running = {"adit-board", "0.1.0", "A", "B"},
                .refusal = "the update is older",
                .doing = "installing",
                .progress = 40,
                .last = {update::Stage::Installing, "0.2.0", "B", "boot", ""}});
  const auto view = updates_.state();
  EXPECT_TRUE(view.managed);
  EXPECT_EQ(view.status.running.version, "0.1.0");
  EXPECT_EQ(view.status.doing, "installing");
  EXPECT_EQ(view.status.progress, 40);
  EXPECT_EQ(view.status.refusal, "the update is older");
  EXPECT_TRUE(updates_.running());
}

TEST_F(UpdatesTest, ReportIfAditUpdateIsMissing) {
  fs::remove(run_ / host::kStatusFile);
  EXPECT_FALSE(updates_.state().managed || updates_.state().runs_here);
  EXPECT_THAT(updates_.state().why, HasSubstr("adit-update does not run here"));
  for (const auto& refused : {upload("x", 1), updates_.install_from_stick(false), updates_.restart(true)}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().status, icd::Status::Conflict);
  }
  wait();
  write_status({.trouble = "RAUC does not run here: no"});
  EXPECT_EQ(updates_.restart(true).error().sentence, "RAUC does not run here: no");
  EXPECT_TRUE(updates_.state().runs_here) << "the error must be shown";
  EXPECT_FALSE(asked());
}

TEST_F(UpdatesTest, ShowANewerVersionFromApt) {
  EXPECT_EQ(updates_.state().newer, std::nullopt);
  EXPECT_EQ(updates_.state().newer_why, "") << "apt is not installed here";
  const std::string file = run_.put(update::kNewerFile, "\n");
  EXPECT_EQ(updates_.state().newer, "");
  run_.put(update::kNewerFile, "1:0.2.0~rc1+deb13\n");
  EXPECT_EQ(updates_.state().newer, "1:0.2.0~rc1+deb13");
  for (const std::string wrong :
       {"", "0.2.0", "0.2 0\n", "0.2.0\n\n", "<b>\n", "apt-cache failed: E: \x1b[2J\n"}) {
    run_.put(update::kNewerFile, wrong);
    EXPECT_EQ(updates_.state().newer, std::nullopt) << wrong;
    EXPECT_THAT(updates_.state().newer_why, StartsWith(file + ": expected a version"));
  }
  EXPECT_THAT(updates_.state().newer_why, EndsWith("got 'apt-cache failed: E: \\x1b[2J'"));
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_EQ(updates_.state().newer, std::nullopt);
  EXPECT_THAT(updates_.state().newer_why, HasSubstr(file));
}

TEST_F(UpdatesTest, StoreAWholeBundleAndRequestIt) {
  std::string bundle;
  for (int i = 0; i < 300'000; ++i) bundle += std::to_string(i);
  ASSERT_TRUE(upload(bundle, bundle.size(), true));
  EXPECT_EQ(content_of(state_ / update::kBundleFile), bundle);
  EXPECT_EQ(fs::status(state_ / update::kBundleFile).permissions(), fs::perms(0600));
  ASSERT_TRUE(asked());
  EXPECT_EQ(asked()->what, update::Request::Command::Install);
  EXPECT_TRUE(asked()->again);
  EXPECT_EQ(updates_.state().status.doing, "checking");
  EXPECT_FALSE(fs::exists(state_ / "update.raucb.part"));
}

TEST_F(UpdatesTest, AcceptOneAtATime) {
  auto first = updates_.receive(100, false, [] {});
  ASSERT_TRUE(first);
  EXPECT_EQ(updates_.state().status.doing, "receiving");
  EXPECT_EQ(updates_.state().status.progress, 0);
  const std::uint8_t piece[50] = {};
  EXPECT_TRUE((*first)->write(piece));
  EXPECT_EQ(updates_.state().status.progress, 50);
  EXPECT_EQ(updates_.receive(100, false, [] {}).error().sentence, "the box is already receiving: wait");
  EXPECT_EQ(updates_.restart(true).error().status, icd::Status::Conflict);
  first->reset();
  EXPECT_EQ(updates_.state().status.doing, "");
  EXPECT_FALSE(fs::exists(state_ / "update.raucb.part"));
  EXPECT_TRUE(updates_.receive(100, false, [] {}));
}

TEST_F(UpdatesTest, RejectATruncatedBundle) {
  EXPECT_THAT(upload("abc", 5).error().sentence, HasSubstr("got 3 of 5 bytes"));
  EXPECT_FALSE(asked());
  EXPECT_TRUE(fs::is_empty(state_.path()));
  EXPECT_EQ(updates_.state().status.doing, "");
}

TEST_F(UpdatesTest, RejectABundleLargerThanTheDisk) {
  const std::uint64_t free = fs::space(state_.path()).available;
  const auto refused = updates_.receive(free, false, [] {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().status, icd::Status::ServiceUnavailable);
  EXPECT_THAT(refused.error().sentence, HasSubstr("the disk has room for"));
}

TEST_F(UpdatesTest, ReportAWriteError) {
  fs::create_directory(state_ / "update.raucb.part");
  EXPECT_THAT(upload("abc", 3).error().sentence, HasSubstr("cannot write the bundle"));
  EXPECT_FALSE(asked());
}

/// Limits the size of files, as a full disk does.
class NoLargerFiles {
 public:
  explicit NoLargerFiles(rlim_t most) : before_(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limits_);
    const rlimit lower{most, limits_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &lower);
  }
  ~NoLargerFiles() {
    setrlimit(RLIMIT_FSIZE, &limits_);
    std::signal(SIGXFSZ, before_);
  }
  NoLargerFiles(const NoLargerFiles&) = delete;
  NoLargerFiles& operator=(const NoLargerFiles&) = delete;

 private:
  rlimit limits_{};
  void (*before_)(int);
};

TEST_F(UpdatesTest, FreeTheDiskAtOnceIfItFillsUp) {
  const std::string part = state_ / "update.raucb.part";
  const NoLargerFiles full(500'000);
  bool may_go_on = true;
  auto upload = updates_.receive(2'000'000, false, [&may_go_on] { may_go_on = true; });
  ASSERT_TRUE(upload);
  const std::vector<std::uint8_t> piece(100'000);
  for (int i = 0; i < 10; ++i) {
    while (!may_go_on) loop_.turn(100ms);
    may_go_on = (*upload)->write(piece);
  }
  EXPECT_TRUE(loop::turn_until(loop_, [&] { return fs::file_size(part) == 0; }))
      << "the file is emptied before the upload ends";
  std::optional<icd::Checked<void>> ended;
  (*upload)->finish([&ended](icd::Checked<void> outcome) { ended = std::move(outcome); });
  ASSERT_TRUE(loop::turn_until(loop_, [&] { return ended.has_value(); }));
  EXPECT_EQ(ended->error().sentence, "cannot write the bundle: File too large");
  EXPECT_TRUE(fs::is_empty(state_.path()));
  EXPECT_FALSE(asked());
}

TEST_F(UpdatesTest, EndWithTheAnswerOfAditUpdate) {
  ASSERT_TRUE(updates_.install_from_stick(true));
  const auto request = asked();
  ASSERT_TRUE(request);
  EXPECT_EQ(request->what, update::Request::Command::Stick);
  EXPECT_EQ(updates_.state().status.doing, "checking");
  write_status({.nonce = request->nonce, .refusal = "no stick has an update"});
  wait();
  EXPECT_EQ(updates_.state().status.doing, "");
  EXPECT_EQ(updates_.state().status.refusal, "no stick has an update");
}

TEST_F(UpdatesTest, RestartDuringAReportOnlyIfConfirmed) {
  under_way_ = "report 7 is being sent";
  EXPECT_EQ(updates_.restart(false).error().sentence, "report 7 is being sent");
  EXPECT_FALSE(asked());
  ASSERT_TRUE(updates_.restart(true));
  EXPECT_EQ(asked()->what, update::Request::Command::Restart);
  EXPECT_EQ(updates_.state().status.doing, "restarting");
}

TEST_F(UpdatesTest, OfferGoBackAndStayInAnUnexpectedSlot) {
  EXPECT_EQ(updates_.restart_proven_slot(true).error().sentence, update::kNoStray);
  EXPECT_EQ(updates_.keep_running_slot().error().status, icd::Status::Conflict);
  EXPECT_FALSE(asked());
  wait();
  write_status({.stray = "slot B runs, with 0.1.0"});
  EXPECT_EQ(updates_.state().status.stray, "slot B runs, with 0.1.0");
  under_way_ = "report 7 is being sent";
  EXPECT_EQ(updates_.restart_proven_slot(false).error().sentence, "report 7 is being sent");
  ASSERT_TRUE(updates_.restart_proven_slot(true));
  EXPECT_EQ(asked()->what, update::Request::Command::Back);
  EXPECT_EQ(updates_.state().status.doing, "restarting");
}

TEST_F(UpdatesTest, RequestToStayInTheSlot) {
  write_status({.stray = "slot B runs, with 0.1.0"});
  ASSERT_TRUE(updates_.keep_running_slot());
  EXPECT_EQ(asked()->what, update::Request::Command::Stay);
}

TEST_F(UpdatesTest, RejectAnotherDuringATrial) {
  write_status({.running = {"adit-board", "0.2.0", "B", "A"}, .trial = true});
  for (const auto& refused : {upload("x", 1), updates_.install_from_stick(false)}) {
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().status, icd::Status::Conflict);
    EXPECT_EQ(refused.error().sentence, "0.2.0 is on trial: wait until it has been healthy for 60 s");
  }
  EXPECT_FALSE(asked());
  EXPECT_TRUE(updates_.restart(false));
}

TEST_F(UpdatesTest, RestartIfNothingIsInFlight) {
  EXPECT_TRUE(updates_.restart(false));
}

}  // namespace
}  // namespace adit::admin
