#include "host/root_program.hpp"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "codec/nonce.hpp"
#include "host/folder.hpp"
#include "loop/simulated_time.hpp"

namespace adit::host {
namespace {

using namespace std::chrono_literals;
using nlohmann::json;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr const char* kFile = "request.json";
constexpr const char* kBeside = "request.data";

struct Request {
  std::string nonce = draw_nonce();
  std::string what = "do it";
  static const codec::Row kRow;
};
struct Status {
  std::string nonce = "";
  bool names(std::string_view request) const { return nonce == request; }
  static const codec::Row kRow;
};
constexpr codec::Member kRequestMembers[] = {
    codec::member<&Request::nonce>("nonce").matching(codec::kNonce),
    codec::member<&Request::what>("what"),
};
constexpr codec::Member kStatusMembers[] = {codec::member<&Status::nonce>("nonce")};
constexpr codec::Row Request::kRow = {"", kRequestMembers};
constexpr codec::Row Status::kRow = {"", kStatusMembers};

TEST(Nonce, IsNeverTheSameTwice) {
  EXPECT_TRUE(codec::is_nonce(draw_nonce()));
  EXPECT_NE(draw_nonce(), draw_nonce());
}

class RootProgramTest : public testing::Test {
 protected:
  /// Writes the status as the program does.
  void write_status(const std::string& nonce) { ASSERT_TRUE(file_.write(Status{nonce})); }
  bool is_left() const { return fs::exists(requests_ / kFile); }
  /// Takes the request as the program does.
  std::optional<Request> taken() {
    auto folder = open_requests(requests_.path());
    return take_request<Request>(**folder, kFile).value();
  }

  Folder requests_, run_;
  loop::SimulatedTime time_;
  loop::Loop loop_;
  StatusFile file_{run_ / kStatusFile};
  RootProgram<Status> program_{loop_, "adit-x", requests_.path(), run_.path(), 60s};
};

TEST_F(RootProgramTest, DoesNotRunHereIfItHasNoStatus) {
  EXPECT_FALSE(program_.runs_here());
  EXPECT_THAT(program_.status_error(), HasSubstr("adit-x does not run here"));
}

TEST_F(RootProgramTest, IsStartingAfterABootIfItHasAUnit) {
  const Folder units;
  units.put("adit-x.service", "");
  const RootProgram<Status> program{loop_, "adit-x", requests_.path(), run_.path(), 60s, units.path()};
  EXPECT_TRUE(program.is_starting() && program.runs_here());
  EXPECT_EQ(program.status_error(), "adit-x is starting, for at most 5 minutes: try again");
  EXPECT_EQ(program.refuse().error().status, icd::Status::ServiceUnavailable);
  write_status("");
  time_.pass(kFresh);
  EXPECT_FALSE(program.is_starting());
  EXPECT_EQ(program.status_error(), "");
  fs::remove(run_ / kStatusFile);
  time_.pass(kBoot);
  EXPECT_FALSE(program.is_starting() || program.runs_here()) << "the program failed to start";
  EXPECT_THAT(program.status_error(), HasSubstr("adit-x does not run here"));
  EXPECT_EQ(program.refuse().error().status, icd::Status::Conflict);
}

TEST_F(RootProgramTest, RunsEvenIfItsStatusIsUnreadable) {
  run_.put(kStatusFile, "{");
  EXPECT_TRUE(program_.runs_here());
  EXPECT_FALSE(program_.status());
  EXPECT_THAT(program_.status_error(), HasSubstr("cannot read the status of adit-x: "));
  fs::remove(run_ / kStatusFile);
  fs::create_directory(run_ / kStatusFile);
  time_.pass(kFresh);
  EXPECT_TRUE(program_.runs_here());
  EXPECT_THAT(program_.status_error(), HasSubstr("cannot read the status of adit-x: "));
}

TEST_F(RootProgramTest, IsReadAgainOnceItsStatusIsOld) {
  write_status("a");
  EXPECT_EQ(program_.status()->nonce, "a");
  write_status("b");
  EXPECT_EQ(program_.status()->nonce, "a");
  time_.pass(kFresh);
  EXPECT_EQ(program_.status()->nonce, "b");
}

TEST_F(RootProgramTest, IsAwaitedUntilItsStatusNamesTheRequest) {
  write_status("");
  const Request request;
  ASSERT_TRUE(program_.ask(kFile, request));
  EXPECT_TRUE(program_.is_pending());
  EXPECT_EQ(fs::status(requests_ / kFile).permissions(), fs::perms(0600));
  EXPECT_EQ(taken()->nonce, request.nonce);
  run_.put(kStatusFile, "{");
  EXPECT_FALSE(program_.check());
  EXPECT_TRUE(program_.is_pending()) << "an unreadable status is not an answer";
  write_status(request.nonce);
  EXPECT_FALSE(program_.check());
  EXPECT_FALSE(program_.is_pending());
  write_status("");
  EXPECT_FALSE(program_.check());
  EXPECT_FALSE(program_.is_pending()) << "a later start of the program does not know the request";
}

TEST_F(RootProgramTest, IsNotAwaitedBeyondItsTimeout) {
  const Request request;
  ASSERT_TRUE(program_.ask(kFile, request));
  time_.pass(60s - 1ms);
  EXPECT_FALSE(program_.check());
  EXPECT_TRUE(program_.is_pending() && is_left());
  time_.pass(1ms);
  EXPECT_TRUE(program_.check());
  EXPECT_FALSE(program_.check()) << "only once";
  EXPECT_FALSE(program_.is_pending() || is_left());
  EXPECT_EQ(program_.trouble(),
            "adit-x did not read the request: restart the box; on a PC, see journalctl -u adit-x");
  write_status(request.nonce);
  program_.check();
  EXPECT_EQ(program_.trouble(), "") << "the answer was late, but it was read";
}

TEST_F(RootProgramTest, AcceptsARequestAfterATimeout) {
  ASSERT_TRUE(program_.ask(kFile, Request{}));
  time_.pass(60s);
  EXPECT_TRUE(program_.check());
  ASSERT_TRUE(program_.ask(kFile, Request{}));
  EXPECT_TRUE(program_.is_pending());
  EXPECT_EQ(program_.trouble(), "");
}

TEST_F(RootProgramTest, IsNotAwaitedIfTheRequestCannotBeWritten) {
  fs::remove_all(requests_.path());
  EXPECT_FALSE(program_.ask(kFile, Request{}));
  EXPECT_FALSE(program_.is_pending());
  fs::create_directory(requests_.path());
}

TEST_F(RootProgramTest, RejectsEachRequestThatIsMalformed) {
  const json good = json::parse(codec::write_file(Request{}));
  for (const char* change :
       {R"({"format":2})", R"({"format":null})", R"({"more":1})", R"({"what":null})", R"({"what":[["x"]]})",
        R"({"nonce":"0123"})", R"({"nonce":7})", R"({"nonce":"0123456789ABCDEF0123456789ABCDEF"})",
        R"({"nonce":"../../../../etc/passwd0000000000"})"}) {
    json bad = good;
    bad.update(json::parse(change));
    requests_.put(kFile, bad.dump());
    EXPECT_FALSE(taken()) << change;
    EXPECT_FALSE(is_left()) << change;
  }
  for (const char* text : {"", "{", "[]", "null", "7", "{\"format\":1}", "\xff\xfe"}) {
    requests_.put(kFile, text);
    EXPECT_FALSE(taken()) << text;
    EXPECT_FALSE(is_left()) << text;
  }
}

class AnsweringTest : public RootProgramTest {
 protected:
  std::expected<void, std::string> answer(bool drop) {
    return answer_requests<Request>({requests_.path(), kFile, kBeside}, drop,
                                    [this](const Request& request, UntrustedFolder&) {
                                      answered_.push_back(request.nonce);
                                      if (answered_.size() == 1)
                                        requests_.put(kFile, codec::write_file(later_));
                                    });
  }
  const Request first_, later_;
  std::vector<std::string> answered_;
};

TEST_F(AnsweringTest, AnswersAllRequests) {
  requests_.put(kFile, codec::write_file(first_));
  EXPECT_TRUE(answer(false));
  EXPECT_THAT(answered_, testing::ElementsAre(first_.nonce, later_.nonce));
  EXPECT_TRUE(fs::is_empty(requests_.path()));
}

TEST_F(AnsweringTest, DropsRequestsFromBeforeTheBoot) {
  requests_.put(kFile, codec::write_file(first_));
  requests_.put(kBeside, "data");
  EXPECT_TRUE(answer(true));
  EXPECT_TRUE(answered_.empty());
  EXPECT_TRUE(fs::is_empty(requests_.path()));
}

TEST_F(AnsweringTest, HasNoRequestsWithoutTheirDirectory) {
  fs::remove_all(requests_.path());
  EXPECT_TRUE(answer(false));
  std::ofstream(requests_.path()) << "no directory";
  EXPECT_FALSE(answer(false)) << "the directory is unreadable";
  fs::remove(requests_.path());
}

TEST(StatusFile, TellsTheFirstStartSinceTheBoot) {
  const Folder run;
  StatusFile file(run / kStatusFile);
  EXPECT_FALSE(file.read_earlier<Status>());
  EXPECT_EQ(file.write(Status{"a"}), true);
  EXPECT_EQ(file.write(Status{"a"}), false) << "the status was written";
  EXPECT_EQ(file.read_earlier<Status>()->nonce, "a");
  run.put(kStatusFile, "{");
  ASSERT_TRUE(file.read_earlier<Status>()) << "an unreadable status is not the first start";
  EXPECT_EQ(file.read_earlier<Status>()->nonce, "");
}

}  // namespace
}  // namespace adit::host
