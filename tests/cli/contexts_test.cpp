#include "cli/contexts.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "cli/run_adit.hpp"
#include "cli/view.hpp"
#include "host/folder.hpp"

namespace adit::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

/// `adit` of a user with a new home.
class ContextsTest : public testing::Test {
 public:
  ~ContextsTest() override {
    for (const char* name : {"XDG_CONFIG_HOME", "ADIT_AT", "ADIT_TOKEN"}) unsetenv(name);
  }

 protected:
  ContextsTest() { setenv("XDG_CONFIG_HOME", home_.path().c_str(), 1); }

  /// The user types `token`.
  static Outcome adit(std::vector<std::string_view> words, const std::string& token = "") {
    const Outcome outcome = run(words, {.read_secret = [token](const std::string& /*question*/) {
                                  return token.empty() ? std::nullopt : std::optional(token);
                                }});
    EXPECT_THAT(outcome.out + outcome.err, Not(HasSubstr("sesame"))) << "the output contains the token";
    return outcome;
  }
  std::string file() const { return home_.path() + "/adit/contexts.json"; }

  host::Folder home_;
  const Server server_{{{"GET /adit/about", Server::ok(R"({"version":"0.9.1","build":"","licence":"",)"
                                                       R"("started":0,"uptime":1,"kernel":"","model":"",)"
                                                       R"("board":null,"parts":[]})")},
                        {"GET /adit/sessions", Server::ok("[]")},
                        {"GET /adit/run", Server::ok(codec::to_json(sample_view()))}}};
};

TEST_F(ContextsTest, ALoginIsUsedByLaterCommands) {
  const Outcome outcome = adit({"login", server_.at(), "--name", "box"}, "sesame-2");
  EXPECT_EQ(outcome.exit, Exit::Fine) << outcome.err;
  EXPECT_EQ(outcome.out,
            "logged in to Adit 0.9.1 at " + server_.at() + "; later commands ask it (context box)\n");
  struct stat status{};
  ASSERT_EQ(stat(file().c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777u, 0600u) << "the token is for this user alone";
  EXPECT_EQ(adit({"run"}).exit, Exit::Fine);
  EXPECT_THAT(server_.request(), HasSubstr("Authorization: Bearer sesame-2\r\n"));
}

TEST_F(ContextsTest, ALoginTakesAUrlAndPutsTheHostIntoTheName) {
  const Outcome outcome = adit({"login", "http://" + server_.at() + "/setup"}, "sesame-2");
  EXPECT_THAT(outcome.out, HasSubstr("(context " + server_.at() + ")"));
  EXPECT_EQ(adit({"run"}).exit, Exit::Fine);
}

TEST_F(ContextsTest, AreListedChosenAndRemoved) {
  adit({"login", server_.at(), "--name", "box"}, "sesame-2");
  adit({"login", server_.at(), "--name", "spare"}, "sesame-3");
  EXPECT_EQ(adit({"context"}).out, "     box    " + server_.at() + "\n  *  spare  " + server_.at() + "\n");
  EXPECT_EQ(adit({"context", "use", "box"}).exit, Exit::Fine);
  adit({"run"});
  EXPECT_THAT(server_.request(), HasSubstr("Bearer sesame-2\r\n"));
  adit({"run", "--at", "spare"});
  EXPECT_THAT(server_.request(), HasSubstr("Bearer sesame-3\r\n")) << "--at names a context";
  EXPECT_THAT(adit({"context", "--json"}).out, HasSubstr(R"({"name":"spare","at":")"));
  EXPECT_THAT(adit({"context", "use", "box", "--json"}).out, HasSubstr(R"("current":true},{"name":"spare")"));
  EXPECT_EQ(adit({"context", "remove", "spare"}).exit, Exit::Fine);
  EXPECT_THAT(adit({"context", "use", "boks"}).err, HasSubstr("there is no context boks; did you mean box?"));
}

TEST_F(ContextsTest, ALoginByAContextsNameReplacesItsToken) {
  adit({"login", server_.at(), "--name", "box"}, "sesame-2");
  EXPECT_EQ(adit({"login", "box"}, "sesame-6").exit, Exit::Fine);
  EXPECT_EQ(adit({"context"}).out, "  *  box  " + server_.at() + "\n");
  EXPECT_EQ(adit({"run"}).exit, Exit::Fine);
  EXPECT_THAT(server_.request(), HasSubstr("Bearer sesame-6\r\n"));
}

TEST_F(ContextsTest, AreNotSavedIfAditRejectsTheToken) {
  const Server strict(Server::reply("401 Unauthorized", "\"wrong\""));
  const Outcome outcome = adit({"login", strict.at()}, "sesame-2");
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_EQ(outcome.err, "adit: Adit rejects the token in the input\n");
  EXPECT_EQ(adit({"context"}).out, "no context: see adit help login\n");
  EXPECT_THAT(adit({"login", server_.at()}).err, HasSubstr("no token was given"));
}

TEST_F(ContextsTest, GiveTheirTokenToNoOtherAddress) {
  adit({"login", server_.at(), "--name", "box"}, "sesame-2");
  const Server other(Server::ok("{}"));
  adit({"run", "--at", other.at()});
  EXPECT_THAT(other.request(), Not(HasSubstr("sesame-2")));
}

TEST_F(ContextsTest, AScriptNamesAddressAndTokenInTheEnvironment) {
  setenv("ADIT_AT", server_.at().c_str(), 1);
  setenv("ADIT_TOKEN", "sesame-4", 1);
  EXPECT_EQ(adit({"run"}).exit, Exit::Fine);
  EXPECT_THAT(server_.request(), HasSubstr("Bearer sesame-4\r\n"));
  EXPECT_EQ(adit({"run", "--token-file", "-"}, "sesame-5").exit, Exit::Fine);
  EXPECT_THAT(server_.request(), HasSubstr("Bearer sesame-5\r\n")) << "a piped token";
}

TEST_F(ContextsTest, ADamagedFileIsNamed) {
  adit({"login", server_.at()}, "sesame-2");
  std::ofstream(file()) << "{";
  const Outcome outcome = adit({"run"});
  EXPECT_EQ(outcome.exit, Exit::Unable);
  EXPECT_THAT(outcome.err, HasSubstr(file() + ": "));
}

}  // namespace
}  // namespace adit::cli
