#include "cli/commands.hpp"

namespace adit::cli {
namespace {

constexpr std::size_t kMany = 1000;
constexpr Argument kNothing{"", "", 0, 0, 0};
constexpr Argument kReport{"NUMBER", "a report's number", 1, 1, INT64_MAX, Among::Reports};
constexpr Argument kReports{"NUMBER...", "a report's number", 1, kMany, INT64_MAX, Among::Reports};
constexpr Argument kRejectedNumber{"NUMBER...",    "the number of what is rejected", 1, kMany, INT64_MAX,
                                   Among::Rejected};
constexpr Argument kSeconds{"[SECONDS]", "seconds, a whole number from 1 to 60", 0, 1, 60};
constexpr Argument kName{"NAME", "a course's name", 1, 1, 0, Among::Courses};
constexpr Argument kRunKey{"KEY", "a run's key", 1, 1, 0, Among::Runs};
constexpr Argument kKey{"[KEY]", "a key of the settings", 0, 1, 0, Among::Keys};
constexpr Argument kFile{"FILE", "a file", 1, 1, 0, Among::Files};
constexpr Argument kBundle{"[FILE]", "a file", 0, 1, 0, Among::Files};
constexpr Argument kExport{"[FILE]", "a file", 0, 1, 0, Among::Files};
constexpr Argument kSettingsFile{"[SETTINGS]", "a file", 0, 1, 0, Among::Files};
constexpr Argument kCommand{"[COMMAND]", "a command", 0, 1, 0, Among::Commands};
constexpr Argument kWord{"[WORD]", "a word of `adit reports`", 0, 1, 0};

constexpr Form kPlain[] = {{"", Verb::List, kNothing, "", "", true}};
constexpr Form kReportForms[] = {
    {"", Verb::List, kNothing, "", "--run", true},
    {"show", Verb::Show, kReport,
     "all of one report: its history, the answer that is kept, and what you can do"},
    {"send", Verb::Send, kReports,
     "a held report: it is meant. One in doubt: only where you know that it was not recorded (ask the "
     "Command Post, or look at its count of reports), for else it uses up a second one of the allotment. A "
     "refused or withdrawn one: try it all the same",
     "--yes"},
    {"hold", Verb::Hold, kReports, "a waiting report: it goes only when you send it"},
    {"withdraw", Verb::Withdraw, kReports,
     "a held or waiting report: it is not to be sent. It can still be sent later"},
    {"done", Verb::Done, kReports,
     "a report in doubt that was recorded, or that is not worth a second one of the allotment"},
    {"resubmit", Verb::Resubmit, kReport,
     "a finished report once more on purpose, as a new one with a number of its own"},
    {"export", Verb::Export, kNothing, "all reports of all runs, as CSV for a spreadsheet or as JSON",
     "--csv"}};
constexpr Form kRejectedForms[] = {
    {"show", Verb::Show, kNothing, "lists them", "", true},
    {"send", Verb::Send, kRejectedNumber,
     "sends it once more, when its turn comes. Adit does not where something newer that says all of it was "
     "sent since: that would put the older in its place"},
    {"discard", Verb::Discard, kRejectedNumber, "forgets it"}};
constexpr Form kRunForms[] = {{"new", Verb::New, kNothing, "declares that a new run begins"}};
constexpr Form kRunsForms[] = {
    {"", Verb::List, kNothing, "", "", true},
    {"show", Verb::Show, kRunKey, "all that is known of one run"},
    {"report", Verb::Report, kRunKey,
     "its report to print, one HTML file: score, each report with its life, the map, coverage, robots, what "
     "needed the operator",
     "--to"},
    {"delete", Verb::Delete, kRunKey,
     "forgets its map, tracks and plots, for good. Its reports stay in the ledger", "--yes"}};
constexpr Form kSettingsForms[] = {
    {"show", Verb::Show, kKey,
     "the settings that differ from what is by default, and which tokens are set; with --json all, and what "
     "each key means. Of KEY (reports.review; or where several begin, reports): its value, what it means and "
     "what it may be",
     "", true},
    {"check", Verb::Check, kFile,
     "what is wrong with FILE, or what it would change and what to mind. Nothing is changed"},
    {"apply", Verb::Apply, kFile,
     "saves FILE on the box and applies it at once: within a second it is in use, and nobody is cut but who "
     "is connected to an address that goes. Where the new settings cannot be used, those before are in use "
     "still, and `adit status` says why"},
    {"export", Verb::Export, kNothing, "the whole settings file, for `apply`. Tokens are never in it"}};
constexpr Form kCourseForms[] = {{"", Verb::List, kName, "", "", true}};
constexpr Form kIdentifyForms[] = {{"", Verb::List, kSeconds, "", "", true}};
constexpr Form kNetworkForms[] = {
    {"show", Verb::Show, kNothing,
     "which addresses the box has on its two sides, and which change waits to be confirmed", "", true},
    {"confirm", Verb::Confirm, kNothing,
     "the change is good and stays. It must be said at the new address, as what reaches Adit there shows "
     "that the address works: adit finds it by team.interface, or name it by --at"},
    {"back", Verb::Back, kNothing, "the change is taken back now"}};
constexpr Form kClockForms[] = {
    {"show", Verb::Show, kNothing,
     "the box's time of day, who set it, and how far it is from this computer's", "", true},
    {"set", Verb::Set, kNothing,
     "to this computer's time. Nothing hangs on it: stamps, sessions and reports go on as they were"}};
constexpr Form kSpareForms[] = {
    {"show", Verb::Show, kNothing,
     "whether the box rests, with the code of its export, and what it took in of another box", "", true},
    {"export", Verb::Export, kExport,
     "puts the box to rest, and writes its export into FILE: ledger, settings and tokens; with --stick onto "
     "the USB stick in the box. It prints the code that opens it: note it. From then on the box takes "
     "nothing and sends nothing, also after a power cut",
     "--stick --yes"},
    {"take", Verb::Take, kExport,
     "on the spare: takes in FILE, or with --stick the file of that name on the USB stick in the box (FILE "
     "may be left out where there is one export on it). It shows what is in it, and takes over once you say "
     "that the box that made it is unplugged",
     "--stick --code --yes"},
    {"wake", Verb::Wake, kNothing,
     "the box goes on. Only where no spare took over from it: else a report may be sent twice", "--yes"}};
constexpr Form kTestForms[] = {
    {"", Verb::List, kNothing, "", "--course --scoring --mapping --scoring-token --mapping-token", true}};
constexpr Form kUpdateForms[] = {
    {"", Verb::List, kBundle, "", "--stick --restart --back --stay --again --anyway", true}};
constexpr Form kHelpForms[] = {{"", Verb::List, kCommand, "", "", true}};
constexpr Form kCompleteForms[] = {
    {"reports", Verb::Reports, kWord, "reports by their numbers: all, or those that WORD can be said of"},
    {"rejected", Verb::Rejected, kNothing, "what is rejected, by its numbers"},
    {"courses", Verb::Courses, kNothing, "the names of courses"},
    {"runs", Verb::Runs, kNothing, "the runs that are kept, by their keys"},
    {"keys", Verb::Keys, kNothing,
     "the keys of the settings, with --json all that is to be known of each; no Adit is asked"}};
constexpr Form kCheckForms[] = {{"", Verb::List, kSettingsFile, "", "", true}};

constexpr CommandRow kCommands[] = {
    {Command::Status, "status", "the run, the Command Post, each robot's maps, and what the operator must do",
     kPlain,
     "First the alarms, then the run as the Command Post last told of it, whether every map arrives, the two "
     "endpoints, how many reports are in which state, and a row for each robot and kind of update.\n"
     "An alarm is\n"
     "  x bad    something does not work\n"
     "  ? ask    it waits for the operator's word\n"
     "  ! wait   it may pass by itself\n"
     "The column 'arriving' says:\n"
     "  up to date, arriving     the Command Post has it, or something waits for its turn\n"
     "  12 s behind              longer than taking turns explains\n"
     "  throttled, failing       the last try came to nothing: the row says why\n"
     "  not arriving, refused    so it has been for long, or for good\n"
     "  quiet                    all has arrived, and nothing new came for a minute\n"
     "  silent                   the robot says nothing any more, against its habit\n"
     "  waiting                  accepted, and nothing has been sent so far\n"
     "Times are as of now; the size is that of the last update that was sent, as it was sent.",
     "there is no alarm, or only ones that may pass (wait)", "there is an alarm that is bad, or asks",
     "  sudo adit status\n"
     "  adit status --at 10.0.0.1:8000 --token-file team.token\n"
     "  sudo adit status --json | jq '.run.remaining_reports'"},
    {Command::Watch, "watch", "the same as `adit status`, as it changes, until you end it", kPlain,
     "On a terminal the screen is drawn again as it changes, at most each second; q or Ctrl-C ends it. "
     "Elsewhere, in a pipe or a file: first all of it, then a line for each change: of the run, of a report, "
     "of an endpoint, of a robot's maps that stop or arrive, of what needs the operator. With --json: what "
     "Adit says, a line as it changes, at most one a second. Where Adit does not answer, it says so and goes "
     "on asking.",
     "it was ended", "",
     "  sudo adit watch\n"
     "  sudo adit watch | tee run.log\n"
     "  sudo adit watch --json | jq --unbuffered '.run.score'"},
    {Command::Reports, "reports",
     "every artifact report and what became of it; and your word on those that wait for it", kReportForms,
     "Without a word: a row for each report of the present run, and for those of other runs that are not "
     "finished, the newest first; with --run those of one run or of all. A line at the end says how many "
     "there are of other runs that are not listed: of earlier ones, and of those at other Command Posts. A "
     "report in doubt holds up no other: take your time.\n"
     "\n"
     "The states (as the JSON and the CSV name them, where that is another word):\n"
     "  held              waits for your word before it is sent; the row says why: a near duplicate,\n"
     "                    the review of all reports, a new run, too many failures, or you hold it\n"
     "                    (received)\n"
     "  waiting           kept on disk; it is sent when its turn comes\n"
     "  sending           on its way\n"
     "  answered          the Command Post recorded it and said so\n"
     "  refused           the Command Post did not record it, and asking again is no use\n"
     "  in doubt, asking  it may have been recorded, but its answer was lost. Adit asks the run's status\n"
     "                    until it is clear, and then settles it or sends it again by itself: there is\n"
     "                    nothing for you to do\n"
     "  in doubt          it may have been recorded, and the run's status cannot tell: only you can\n"
     "                    decide\n"
     "  settled           its answer was lost, and the run's status showed that it was recorded\n"
     "  called done       you said that nothing is left to do about it (settled)\n"
     "  withdrawn         taken back before it was sent\n"
     "  same as 3         it is report 3 over again, and got that one's answer (withdrawn)",
     "no report waits for your word; of your word: all is done",
     "one does (held, or in doubt); of your word: a report is not there, or is where that\n"
     "     cannot be said of it",
     "  sudo adit reports\n"
     "  sudo adit reports show 14\n"
     "  sudo adit reports done 14\n"
     "  sudo adit reports send 15 16\n"
     "  sudo adit reports export > reports.csv\n"
     "  sudo adit reports --run all --json | jq -r '.[] | [.number, .type, .state] | @tsv'"},
    {Command::Rejected, "rejected",
     "maps, states and markers that the Command Post would not take, and your word on them", kRejectedForms,
     "Each message that was rejected: because the Command Post refused it (400, 413, 422), or because it "
     "failed at it again and again (500) while others passed. They are kept, the newest hundred, until you "
     "say what becomes of them.",
     "nothing needs your word; of your word: it is done",
     "something is rejected that nothing newer has replaced, or your word could not be done", ""},
    {Command::Run, "run", "tells Adit that a new run begins", kRunForms,
     "Adit notices a new run by itself where the run's name or the team changes, where more reports are left "
     "than before, or where a run clock that was seen to run goes back. Where only that clock tells of it, "
     "the same report as one of the run before is held until an answer names the run. Where Adit cannot "
     "notice it (the next run went on from the same clock), this declares it. Reports that were not sent "
     "before are held, so that none of the old run is sent into the new one unless you say so: adit reports "
     "send. The same report as one of an earlier run is then a new report.",
     "a new run has begun", "", "  sudo adit run new"},
    {Command::Runs, "runs", "the runs that are kept: their scores, their reports to print, their end",
     kRunsForms,
     "Without a word: a row for each run whose map, tracks and plots are kept, the latest first. KEY is what "
     "stands first in its row: the run's number, and more where two have the same. On the page they can be "
     "looked at again (/runs).",
     "they are shown, or it is done", "there is no such run, or it cannot be done",
     "  sudo adit runs\n"
     "  sudo adit runs report 3 --to run-3.html\n"
     "  sudo adit runs delete 1\n"
     "  sudo adit runs --json | jq -r '.runs[] | [.key, .course, .score] | @tsv'"},
    {Command::Settings, "settings", "what the running Adit is set to, and changes to it", kSettingsForms, "",
     "all is well", "something is wrong with FILE, or somebody else changed the settings at the same time",
     "  sudo adit settings export > box.json\n"
     "  sudo adit settings check box.json && sudo adit settings apply box.json"},
    {Command::Course, "course", "switches to the Command Post of another course", kCourseForms,
     "NAME is one of the courses in the settings; \"\" means none, the endpoints of command_post itself. It "
     "says how many reports wait, are in doubt or are held: they are kept for the run at the old endpoint, "
     "and none of them is sent to the new one unless you say so (adit reports send). Back there, that run is "
     "taken up again with its reports: what waits goes, what is in doubt is found out, and the same report "
     "again gets the recorded answer. Where nothing was heard from the old endpoint (a mistyped address), "
     "what waits is sent to the first that answers.",
     "the course is in use", "there is no such course", "  sudo adit course B"},
    {Command::Identify, "identify", "makes the box's lights flash, to tell it from others", kIdentifyForms,
     "All lights flash twice a second, together, for SECONDS (1 to 60; 10 if not given): no condition shows "
     "that. Then they show again how things stand.",
     "they flash", "", "  sudo adit identify 30"},
    {Command::Network, "network", "the box's own addresses, and your word on a change of them that waits",
     kNetworkForms,
     "A change is made on the page. It is tried at once, and takes itself back unless it is confirmed in "
     "time (network.confirm_within_ms), so that a wrong address costs a minute and not the box.",
     "no change waits; of your word: it is done",
     "a change waits; of your word: none waits, or it cannot be said there",
     "  sudo adit network\n"
     "  sudo adit network confirm --at 192.168.8.11:8000"},
    {Command::Clock, "clock", "the box's time of day, and your word on it", kClockForms,
     "A box without a battery begins with the last time it knew. Then the `Date` of the Command Post's "
     "answers sets it, or a robot's stamps, or you do: here, or on the page, which asks where a browser's "
     "time is another. An NTP server of the team that the settings name (clock.ntp_server) sets it and keeps "
     "it: while it answers, nobody else may. With clock.serve_ntp the team's network has the box's time.",
     "the time is set; of your word: it is being set", "it is not set, or could not be",
     "  adit clock\n"
     "  adit clock set --at 10.0.0.1:8000 --token-file team.token"},
    {Command::Test, "test", "tries each endpoint of the Command Post step by step, and spends no report",
     kTestForms,
     "What it tries:\n"
     "  link     does the interface to the Command Post have a carrier\n"
     "  address  does it have an address, and does anybody else on its network have the same\n"
     "  cables   is the Command Post's network at its own port, and not at the team's\n"
     "  reach    does the endpoint take a connection\n"
     "  token    does it take the token\n"
     "  clock    does the box's clock agree with the Command Post's, to 2 s\n"
     "Each step is good, BAD or skipped, with what was found, and with what to do about it.\n"
     "\n"
     "With an address, a token or a course it tries that before it is applied, and the run goes on: where "
     "only one "
     "endpoint is named, only that one is tried.",
     "no step is bad", "one is",
     "  sudo adit test\n"
     "  sudo adit test --scoring 10.100.2.200:8000 --mapping 10.100.2.201:8000\n"
     "  sudo adit test --json | jq '.endpoints[].steps[] | select(.state == \"bad\")'"},
    {Command::Spare, "spare", "a second box takes over from this one, with all that is known of the reports",
     kSpareForms,
     "A report that the first box knows is known to its spare, so that none is sent twice over the swap. In "
     "this order:\n"
     "  1. on the first box: adit spare export FILE, or --stick; it rests from then on\n"
     "  2. unplug it\n"
     "  3. on the spare, at its own address: adit spare take FILE, or --stick\n"
     "  4. give the spare the addresses of the first box (adit network, or the set-up page) and its cables\n"
     "What the first box had not sent yet is in doubt at the spare until the run's status shows that nobody "
     "sent it since: that takes some 10 s, and then it goes. The export is sealed by its code, which is not "
     "in it.",
     "the box neither rests nor has an export that waits; of your word: it is done",
     "it rests, or an export waits; of your word: it cannot be done, or you said no",
     "  sudo adit spare export /media/stick/box.adit-spare\n"
     "  sudo adit spare take /media/stick/box.adit-spare --code '1234 5678 9012 3456'\n"
     "  adit spare export --stick --at 10.0.0.1:8000 --token-file team.token"},
    {Command::Update, "update", "the box's version, and the installation of another", kUpdateForms,
     "Without a word it tells which version runs, in which of the two slots, and what became of the last "
     "update; and where another slot runs than the one that was good last, why, and the two ways on: --back "
     "and --stay. FILE is an update, adit-BOARD-VERSION.raucb: it is sent to the box, checked there, and "
     "installed into the slot that does not run. That takes some minutes, and all goes on meanwhile.\n"
     "\n"
     "What is installed is on trial: it stays once it has been healthy for a minute; where it does not come "
     "up in three starts, the box goes back to the version before by itself. Another board's update, one "
     "that is not signed with a key that the box knows, and an older version are refused.",
     "all is well",
     "the update was refused, failed or was left; another slot runs than the one that was good last; a\n"
     "     report is under way; nothing can be updated here",
     "  sudo adit update adit-qemu-virt-0.2.0.raucb && sudo adit update --restart"},
    {Command::Check, "check", "all that is wrong with a settings file, at once", kCheckForms,
     "Reads SETTINGS (/etc/adit/settings.json if not given) exactly as aditd would, and names each error by "
     "the path of its key, with what was expected and what was found. Of good settings it says what they "
     "come to, and warns of a token of the Command Post's that has not 16 characters, and of a team's "
     "network "
     "that overlaps the Command Post's. It neither asks nor changes a running Adit.",
     "aditd would take the file", "it would not",
     "  adit check\n"
     "  adit check new.json && sudo install -m 644 new.json /etc/adit/settings.json"},
    {Command::Complete, "complete", "lists what may stand in a command: for the completion of shells",
     kCompleteForms,
     "Each line is a word that may stand there, a tab, and what it is. Where Adit cannot be reached, there "
     "is none.",
     "they are listed", "", "  adit complete reports send"},
    {Command::Help, "help", "explains a command: adit help COMMAND", kHelpForms, "", "", "", ""}};

}  // namespace

std::span<const CommandRow> commands() {
  return kCommands;
}

}  // namespace adit::cli
