#include "applier/import.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include "access/password.hpp"
#include "applier/power_cut.hpp"
#include "host/folder.hpp"
#include "network/doubles.hpp"
#include "network/messages.hpp"
#include "settings/sample.hpp"
#include "settings/written.hpp"

namespace adit::applier {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* kCourse =
    R"(, "courses": [{"name": "A", "scoring": {"address": "10.100.2.200", "port": 8000},)"
    R"( "mapping": {"address": "10.100.2.201", "port": 8000}}])";

class ImportTest : public testing::Test {
 protected:
  ImportTest() {
    options.card = folder / "boot/adit";
    options.state = folder / "private/adit";
    options.network = folder / "adit-network";
    options.given = folder.put("given.json", settings::sample());
    options.in_memory = folder / "notices/state";
    fs::create_directories(options.card + "/secrets");
  }

  void bring(const std::string& name, const std::string& text) const {
    folder.put("boot/adit/" + name, text);
  }
  void bring_all() const {
    bring("settings.json", settings::sample("", R"(, "connections": 33)", kCourse));
    bring("network.json", network::json_of(numbers));
    bring("secrets/scoring.token", "scoring-1\r\n");
    bring("secrets/course.A.mapping.token", "mapping-of-A");
  }
  void import() const {
    const auto done = Import(options).run();
    EXPECT_TRUE(done) << done.error();
  }
  static std::string text(const std::string& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  std::string taken() const { return text(options.card + "/taken.txt"); }
  std::string state(const std::string& name) const { return text(options.state + '/' + name); }
  bool on_card(const std::string& name) const { return fs::exists(options.card + '/' + name); }
  /// Checks that everything from bring_all() is in its place.
  void expect_all_taken() const {
    const auto saved = settings::parse(state("settings.json"));
    ASSERT_TRUE(saved);
    EXPECT_EQ(saved->team.connections, 33u);
    EXPECT_EQ(state("secrets/scoring.token"), "scoring-1\n");
    EXPECT_EQ(state("secrets/course.A.mapping.token"), "mapping-of-A\n");
    EXPECT_EQ(network::read_kept(text(options.network + "/confirmed.json")), numbers);
    for (const char* gone : {"settings.json", "network.json", "secrets/scoring.token"})
      EXPECT_FALSE(on_card(gone)) << gone;
  }
  /// Checks that the error is reported and nothing is imported.
  void expect_refused(const std::string& name, const std::string& brought, const std::string& what) {
    for (const std::string& path : {options.card, options.state, options.network}) fs::remove_all(path);
    fs::create_directories(options.card + "/secrets");
    bring_all();
    bring(name, brought);
    import();
    EXPECT_THAT(taken(), AllOf(StartsWith("Adit accepted no file."), HasSubstr("adit/" + name + ": "),
                               HasSubstr(what)));
    EXPECT_FALSE(fs::exists(options.state)) << name << ' ' << brought;
    EXPECT_FALSE(fs::exists(options.network));
    for (const char* stays : {"settings.json", "network.json", "secrets/scoring.token"})
      EXPECT_TRUE(on_card(stays)) << stays;
  }

  host::Folder folder;
  ImportOptions options;
  const network::Numbers numbers = network::numbers("10.0.0.1/24", "10.100.1.10/24", "10.100.1.1");
};

TEST_F(ImportTest, ImportsAllFilesAndReportsThem) {
  bring_all();
  import();
  expect_all_taken();
  EXPECT_EQ(taken(),
            "Adit accepted these files:\n"
            "adit/settings.json: accepted\n"
            "adit/network.json: accepted\n"
            "adit/secrets/course.A.mapping.token: accepted, and removed from here\n"
            "adit/secrets/scoring.token: accepted, and removed from here\n");
  EXPECT_TRUE(on_card("settings.json.taken"));
  EXPECT_TRUE(on_card("network.json.taken"));
}

TEST_F(ImportTest, ImportsNothingTwice) {
  bring_all();
  import();
  const std::string said = taken();
  std::ofstream(options.state + "/settings.json") << "what the page saved since";
  import();
  EXPECT_EQ(state("settings.json"), "what the page saved since");
  EXPECT_EQ(taken(), said);
}

TEST_F(ImportTest, RepeatsAtEachStartIfNothingCanBeStored) {
  fs::create_directory(folder / "notices");
  folder.put("notices/state", "the state partition is unusable");
  bring_all();
  for (int start = 0; start < 2; ++start) {
    import();
    EXPECT_EQ(settings::parse(state("settings.json"))->team.connections, 33u);
    EXPECT_EQ(state("secrets/scoring.token"), "scoring-1\n");
    EXPECT_EQ(network::read_kept(text(options.network + "/confirmed.json")), numbers);
    EXPECT_EQ(text(options.card + "/secrets/scoring.token"), "scoring-1\r\n");
    EXPECT_TRUE(on_card("settings.json") && on_card("network.json"));
    EXPECT_THAT(taken(), AllOf(StartsWith("Adit cannot store these files"), Not(HasSubstr("removed"))));
    for (const std::string& path : {options.state, options.network}) fs::remove_all(path);
  }
  fs::remove_all(folder / "notices");
  import();
  expect_all_taken();
}

TEST_F(ImportTest, ImportsEachFileAlone) {
  bring("secrets/team.token", "team-1");
  import();
  EXPECT_EQ(state("secrets/team.token"), "team-1\n");
  EXPECT_FALSE(fs::exists(options.state + "/settings.json"));
  EXPECT_FALSE(fs::exists(options.network + "/confirmed.json"));
  bring("network.json", network::json_of(numbers));
  import();
  EXPECT_TRUE(fs::exists(options.network + "/confirmed.json"));
}

TEST_F(ImportTest, ImportsAddressesAsTheBoxStoresThem) {
  bring("network.json", network::write_kept(numbers));
  import();
  EXPECT_EQ(network::read_kept(text(options.network + "/confirmed.json")), numbers);
  expect_refused("network.json", R"({"format": 2, "numbers": {}})", "adit/network.json: ");
}

TEST_F(ImportTest, ReportsNothingWithoutFiles) {
  import();
  EXPECT_FALSE(on_card("taken.txt"));
  fs::remove_all(options.card);
  import();
  EXPECT_FALSE(fs::exists(options.state));
}

TEST_F(ImportTest, AcceptsByteOrderMarksAndCrLf) {
  bring("settings.json", "\xef\xbb\xbf" + settings::sample());
  bring("secrets/team.token", "\xef\xbb\xbfteam-1\r\n");
  import();
  EXPECT_TRUE(settings::parse(state("settings.json")));
  EXPECT_EQ(state("secrets/team.token"), "team-1\n");
}

TEST_F(ImportTest, RejectsSettingsWithThePathOfTheFault) {
  expect_refused("settings.json", settings::sample(R"(, "interfce": "darpa0")"),
                 "command_post.interfce: no such key");
  expect_refused("settings.json", settings::sample("", R"(, "connections": 0)"), "team.connections: ");
  expect_refused("settings.json", "{", "adit/settings.json: ");
  expect_refused("settings.json", "", "adit/settings.json: ");
  expect_refused("settings.json", std::string(70000, ' '), "large");
}

TEST_F(ImportTest, RejectsAddressesWithThePathOfTheFault) {
  const std::string good = network::json_of(numbers);
  const auto with = [&good](const std::string& what, const std::string& by) {
    std::string text = good;
    return text.replace(text.find(what), what.size(), by);
  };
  expect_refused("network.json", with("10.0.0.1", "10.0.0.256"), "team.address: ");
  expect_refused("network.json", with("10.100.1.10", "10.100.1.255"), "command_post");
  expect_refused("network.json", with("10.0.0.1", "10.100.1.20"), "overlap");
  expect_refused("network.json", "[]", "expected an object");
  expect_refused("network.json", "{\"team\": ", "adit/network.json: ");
  expect_refused("network.json", std::string(70000, ' '), "large");
}

TEST_F(ImportTest, ImportsTheCodeForTheFirstPassword) {
  bring("secrets/label.code", "12345678\r\n");
  import();
  EXPECT_EQ(state(access::kCodeFile), "12345678\n");
  EXPECT_FALSE(fs::exists(options.state + "/secrets/label.code"));
  EXPECT_FALSE(on_card("secrets/label.code"));
  for (const char* bad : {"", "1234567", "123456789", "1234567a"})
    expect_refused("secrets/label.code", bad, "expected 8 digits");
}

TEST_F(ImportTest, RejectsTokensWithoutShowingThem) {
  for (const std::string bad : {"", " \r\n", "two words", "tok\xc3\xa9n", "a\nb"}) {
    expect_refused("secrets/mapping.token", bad, "expected one token of 1 to 256 visible ASCII characters");
  }
  expect_refused("secrets/mapping.token", std::string(257, 'x'), "1 to 256");
  EXPECT_THAT(taken(), Not(HasSubstr("xxx")));
  expect_refused("secrets/mapping.token", std::string(70000, 'x'), "large");
  expect_refused("secrets/scorin.token", "token-1", "unknown name; expected one of scoring.token, ");
  expect_refused("secrets/course.B.scoring.token", "token-1", "course.A.scoring.token");
  expect_refused("secrets/scoring.token.txt", "token-1", "unknown name");
}

TEST_F(ImportTest, ReportsAllFaultsAtOnce) {
  bring("settings.json", settings::sample(R"(, "a": 1, "b": 2)"));
  bring("network.json", "[]");
  bring("secrets/x", "");
  import();
  EXPECT_THAT(taken(), AllOf(HasSubstr("command_post.a"), HasSubstr("command_post.b"),
                             HasSubstr("adit/network.json"), HasSubstr("adit/secrets/x")));
}

TEST_F(ImportTest, ImportsOnlyRegularFiles) {
  folder.put("elsewhere", settings::sample());
  ASSERT_EQ(symlink((folder / "elsewhere").c_str(), (options.card + "/settings.json").c_str()), 0);
  ASSERT_EQ(mkfifo((options.card + "/network.json").c_str(), 0600), 0);
  fs::create_directory(options.card + "/secrets/team.token");
  import();
  EXPECT_THAT(taken(),
              AllOf(HasSubstr("adit/settings.json: "), HasSubstr("adit/network.json: is not a regular file"),
                    HasSubstr("adit/secrets/team.token: is not a regular file")));
  EXPECT_FALSE(fs::exists(options.state));
  fs::remove_all(options.card + "/secrets");
  bring("secrets", "no folder");
  import();
  EXPECT_THAT(taken(), HasSubstr("adit/secrets: expected a directory"));
}

TEST_F(ImportTest, StaysFastForACardFullOfFiles) {
  for (int i = 0; i < 300; ++i) bring("secrets/" + std::to_string(i), "");
  import();
  EXPECT_THAT(taken(), HasSubstr("adit/secrets: holds more than 256 files"));
}

TEST_F(ImportTest, KeepsOtherFilesAndListsWhatItImports) {
  bring("settings.json.txt", settings::sample());
  bring("._settings.json", "");
  bring("secrets/._team.token", "");
  import();
  EXPECT_EQ(taken(),
            "adit/settings.json.txt: ignored; Adit reads settings.json, network.json and secrets/*.token\n");
}

TEST_F(ImportTest, PutsSettingsOnTrial) {
  fs::create_directories(options.state);
  std::ofstream(options.state + "/settings.json") << "those before";
  bring("settings.json", settings::sample());
  import();
  EXPECT_EQ(state("settings.json.before"), "those before");
  bring("settings.json", settings::sample());
  import();
  EXPECT_EQ(state("settings.json.before"), "those before") << "the last settings that worked";
}

TEST_F(ImportTest, AcceptsTokensOfCoursesInTheSettings) {
  bring("secrets/course.A.scoring.token", "token-1");
  import();
  EXPECT_THAT(taken(), HasSubstr("unknown name"));
  fs::create_directories(options.state);
  std::ofstream(options.state + "/settings.json") << settings::sample("", "", kCourse);
  import();
  EXPECT_EQ(state("secrets/course.A.scoring.token"), "token-1\n");
}

TEST_F(ImportTest, AcceptsTokensOfCoursesInLaterSettings) {
  fs::create_directories(options.state);
  std::ofstream(options.state + "/settings.json") << settings::sample("", R"(, "of_later": 1)", kCourse);
  bring("secrets/course.A.scoring.token", "token-1");
  import();
  EXPECT_EQ(state("secrets/course.A.scoring.token"), "token-1\n");
}

TEST_F(ImportTest, ImportsNothingIfTheSettingsInUseCannotBeRead) {
  fs::create_directories(options.state + "/settings.json");
  bring("network.json", network::json_of(numbers));
  const auto done = Import(options).run();
  ASSERT_FALSE(done) << "the addresses were checked against the settings of the image";
  EXPECT_THAT(done.error(), StartsWith("cannot read the settings in use: settings.json"));
  EXPECT_THAT(taken(), StartsWith("Adit accepted no file, because it cannot read the settings in use: "));
  EXPECT_TRUE(on_card("network.json"));
  EXPECT_FALSE(fs::exists(options.network + "/confirmed.json"));
}

TEST_F(ImportTest, ImportsSettingsOnceDespiteADirectoryInTheWay) {
  fs::create_directories(options.card + "/settings.json.taken/of/somebody");
  bring("settings.json", settings::sample());
  import();
  EXPECT_FALSE(on_card("settings.json"));
  EXPECT_TRUE(fs::is_regular_file(options.card + "/settings.json.taken"));
}

TEST_F(ImportTest, GivesFilesToTheOwnerOfTheState) {
  if (geteuid() != 0) GTEST_SKIP() << "needs root";
  fs::create_directories(options.state);
  ASSERT_EQ(chown(options.state.c_str(), 64001, 64002), 0);
  bring_all();
  import();
  for (const char* name : {"settings.json", "settings.json.before", "secrets", "secrets/scoring.token"}) {
    struct stat status{};
    ASSERT_EQ(lstat((options.state + '/' + name).c_str(), &status), 0) << name;
    EXPECT_EQ(status.st_uid, 64001u) << name;
    EXPECT_EQ(status.st_gid, 64002u) << name;
    EXPECT_EQ(status.st_mode & 077, 0u) << name;
  }
}

TEST_F(ImportTest, FollowsNoLinksInAForeignState) {
  fs::create_directories(options.state);
  fs::create_directory(folder / "elsewhere");
  ASSERT_EQ(symlink((folder / "elsewhere").c_str(), (options.state + "/secrets").c_str()), 0);
  bring("secrets/team.token", "team-1");
  EXPECT_FALSE(Import(options).run());
  EXPECT_TRUE(fs::is_empty(folder / "elsewhere"));
  EXPECT_THAT(taken(), StartsWith("Adit could not store these files: "));
  EXPECT_TRUE(on_card("secrets/team.token"));
}

TEST_F(ImportTest, ImportsNothingFromAReadOnlyCard) {
  bring_all();
  fs::create_directory(options.card + "/taken.txt");  // a directory in the place of the file
  const auto done = Import(options).run();
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error(), HasSubstr("cannot write to the card"));
  EXPECT_FALSE(fs::exists(options.state));
}

TEST_F(ImportTest, WipesTokensBeforeUnlinking) {
  bring("secrets/team.token", "team-token-1");
  fs::create_hard_link(options.card + "/secrets/team.token", folder / "the-same-blocks");
  import();
  EXPECT_EQ(text(folder / "the-same-blocks"), std::string(12, '\0'));
}

TEST_F(ImportTest, CompletesAfterAPowerCutAtAnyPoint) {
  int cuts = 0;
  for (bool was_cut = true; was_cut; ++cuts) {
    for (const std::string& path : {options.card, options.state, options.network}) fs::remove_all(path);
    fs::create_directories(options.card + "/secrets");
    bring_all();
    was_cut = cut_at(cuts + 1, [this] { (void)Import(options).run(); });
    // Until everything is in the state directory, everything is on the card.
    const bool all_there = on_card("settings.json") && on_card("network.json") &&
                           on_card("secrets/scoring.token") &&
                           text(options.card + "/secrets/scoring.token") == "scoring-1\r\n";
    if (!all_there) {
      EXPECT_TRUE(settings::parse(state("settings.json"))) << "cut at " << cuts + 1;
    }
    import();
    expect_all_taken();
    EXPECT_TRUE(fs::is_empty(options.card + "/secrets")) << "cut at " << cuts + 1;
  }
  EXPECT_GT(cuts, 30) << "the cuts did not happen";
}

}  // namespace
}  // namespace adit::applier
