#include "cli/commands.hpp"

#include "cli/handlers.hpp"

namespace adit::cli {
namespace {

constexpr std::size_t kMany = 1000;
constexpr Argument kNothing{"", "", 0, 0, 0};
constexpr Argument kReport{"NUMBER", "a report's number", 1, 1, INT64_MAX};
constexpr Argument kReports{"NUMBER...", "a report's number", 1, kMany, INT64_MAX};
constexpr Argument kCorrection{"NUMBER FIELD=VALUE...", "a report's number or a value", 2, 5, 0};
constexpr Argument kRejectedNumber{"NUMBER...", "a rejected message's number", 1, kMany, INT64_MAX};
constexpr Argument kSeconds{"[SECONDS]", "seconds, a whole number from 1 to 60", 0, 1, 60};
constexpr Argument kName{"[NAME]", "a course's name", 0, 1, 0};
constexpr Argument kRunKey{"KEY", "a run's key", 1, 1, 0};
constexpr Argument kKey{"[KEY]", "a settings key", 0, 1, 0};
constexpr Argument kKeyAndValue{"KEY VALUE", "a settings key or its value", 2, 2, 0};
constexpr Argument kFile{"FILE", "a file", 1, 1, 0};
constexpr Argument kFileIfAny{"[FILE]", "a file", 0, 1, 0};
constexpr Argument kDirectory{"[DIRECTORY]", "a directory", 0, 1, 0};
constexpr Argument kSettingsFile{"[SETTINGS]", "a file", 0, 1, 0};
constexpr Argument kFields{"FIELD=VALUE...", "a value", 4, 4, 0};
constexpr Argument kNumbers{"KEY=VALUE...", "an address", 1, 3, 0};
constexpr Argument kAlarm{"ID", "an alarm's id", 1, 1, 0};
constexpr Argument kToken{"NAME [FILE]", "a token's name or its file", 1, 2, 0};
constexpr Argument kTokenName{"NAME", "a token's name", 1, 1, 0};
constexpr Argument kRole{"[ROLE]", "operator or viewer", 0, 1, 0};
constexpr Argument kAddress{"ADDRESS", "an address", 1, 1, 0};
constexpr Argument kContextName{"NAME", "a context's name", 1, 1, 0};
constexpr Argument kWord{"[WORD]", "a subcommand of `adit reports`", 0, 1, 0};

constexpr Form kStatusForms[] = {{"", status, kNothing, "", "", true}};
constexpr Form kWatchForms[] = {{"", watch, kNothing, "", "", true}};
constexpr Form kAlarmForms[] = {
    {"show", list_alarms, kNothing, "show the alarms, each with its reason and its id (default)", "", true},
    {"acknowledge", acknowledge, kAlarm, "make an alarm quiet until it gets worse or begins again"}};
constexpr Form kReportForms[] = {
    {"", list_reports, kNothing, "", "--run --last", true},
    {"show", show_report, kReport, "show one report, its history and the possible actions"},
    {"send", decide_on_reports, kReports,
     "send a held, rejected or withdrawn report; or one in doubt, if the Command Post did not record it "
     "(otherwise this uses up a second report)",
     "--yes"},
    {"hold", decide_on_reports, kReports, "hold a queued report until you send it"},
    {"withdraw", decide_on_reports, kReports,
     "withdraw a held or queued report. You can still send it later"},
    {"correct", correct_report, kCorrection,
     "send a held report with another type or place, as a new report: type=TYPE, x=X, y=Y, z=Z. It keeps the "
     "other values. The held report is withdrawn"},
    {"compose", compose_report, kFields,
     "send a report of your own: type=TYPE, x=X, y=Y, z=Z, in metres. Adit treats it as a robot's"},
    {"settle", decide_on_reports, kReports, "settle a report in doubt without sending it again"},
    {"resubmit", decide_on_reports, kReport,
     "send a finished report again, as a new report with its own number"},
    {"export", export_reports, kNothing, "print all reports of all runs as CSV, or with --json as JSON",
     "--csv"}};
constexpr Form kRejectedForms[] = {
    {"show", list_rejected, kNothing, "list them (default)", "", true},
    {"send", decide_on_rejected, kRejectedNumber,
     "send a message again. Adit rejects this if it has sent a newer message that replaces it"},
    {"discard", decide_on_rejected, kRejectedNumber, "delete a message"}};
constexpr Form kRunForms[] = {
    {"show", show_present_run, kNothing, "show the present run (default)", "", true},
    {"new", begin_run, kNothing, "declare that a new run begins; this cannot be undone", "--yes"}};
constexpr Form kRunsForms[] = {
    {"", list_runs, kNothing, "", "", true},
    {"show", show_run, kRunKey, "show one run"},
    {"report", print_run, kRunKey,
     "print the run's report as one HTML file: score, reports, map, coverage, robots, alarms", "--to"},
    {"delete", delete_run, kRunKey,
     "delete the run's map, tracks and plots for good. Its reports stay in the ledger", "--yes"}};
constexpr Form kSettingsForms[] = {
    {"show", show_settings, kKey,
     "show the settings that differ from the defaults, and the tokens that are set (default); with KEY: its "
     "value, meaning and range",
     "", true},
    {"set", set_setting, kKeyAndValue, "change one setting and apply it at once"},
    {"check", check_settings, kFile, "list the errors in FILE, or the changes that it would make"},
    {"apply", apply_settings, kFile, "replace all settings by FILE and apply them at once"},
    {"export", export_settings, kNothing, "print the settings file for `apply`. It contains no tokens"}};
constexpr Form kTokenForms[] = {
    {"show", show_tokens, kNothing, "show which tokens are set (default)", "", true},
    {"set", set_token, kToken,
     "save a token and apply it at once; it is in FILE, or you type it, or a program pipes it in"},
    {"remove", remove_token, kTokenName, "remove a saved token; then the token of the installation is used"}};
constexpr Form kPasswordForms[] = {
    {"set", set_password, kRole,
     "set the password of ROLE (operator, if not given, or viewer). Its sessions end. Type the operator's "
     "present password first; on a new box the code of its label"},
    {"remove", remove_password, kNothing, "remove the viewers' password"}};
constexpr Form kResetForms[] = {{"", reset_box, kNothing, "", "--yes", true}};
constexpr Form kLogForms[] = {{"", show_log, kNothing, "", "--follow --level --text", true}};
constexpr Form kBundleForms[] = {{"", fetch_bundle, kFileIfAny, "", "", true}};
constexpr Form kLoginForms[] = {{"", log_in, kAddress, "", "--token-file --name", true}};
constexpr Form kContextForms[] = {
    {"show", show_contexts, kNothing, "list the contexts, and mark the one in use (default)", "", true},
    {"use", use_context, kContextName, "ask this Adit from now on"},
    {"remove", remove_context, kContextName, "remove a context and its token"}};
constexpr Form kVersionForms[] = {{"", show_version, kNothing, "", "--at --token-file", true}};
constexpr Form kCourseForms[] = {{"", course, kName, "", "", true}};
constexpr Form kIdentifyForms[] = {{"", identify, kSeconds, "", "", true}};
constexpr Form kNetworkForms[] = {
    {"show", show_network, kNothing,
     "show the addresses of both ports, and a change to be confirmed (default)", "", true},
    {"set", change_network, kNumbers,
     "change addresses: team=ADDRESS/PREFIX (or dhcp, link-local), command_post=ADDRESS/PREFIX,..., "
     "gateway=ADDRESS. Others stay"},
    {"confirm", decide_on_network, kNothing,
     "keep the change. The box accepts this at its new address only; adit finds that address by "
     "team.interface or --at"},
    {"revert", decide_on_network, kNothing, "return to the old addresses now"}};
constexpr Form kClockForms[] = {
    {"show", show_clock, kNothing,
     "show the box's time of day, its source, and the difference to this computer (default)", "", true},
    {"set", set_clock, kNothing,
     "set the time to this computer's. Stamps, sessions and reports are not affected"}};
constexpr Form kCertificateForms[] = {
    {"show", show_certificate, kNothing,
     "show whether the box offers HTTPS, and its certificate's fingerprint (default)", "", true},
    {"set", set_certificate, kFile,
     "replace the certificate by the one in FILE (PEM): the private key without a passphrase, the page's "
     "certificate, and those that sign it, in order"},
    {"new", make_certificate, kNothing, "replace the certificate by a new one of the box's own", "--yes"}};
constexpr Form kSpareForms[] = {
    {"show", show_spare, kNothing,
     "show whether the box is on standby, and the export that it imported (default)", "", true},
    {"export", export_spare, kFileIfAny,
     "put the box on standby: it accepts and sends no messages, even after a power cut. Write its ledger, "
     "settings and tokens to FILE, and print the code that opens it",
     "--stick --yes"},
    {"take", take_spare, kFileIfAny,
     "on the spare: import FILE, show its content, and take over once you confirm. With --stick, FILE may be "
     "left out if the stick holds one export",
     "--stick --code --yes"},
    {"resume", resume_service, kNothing,
     "end the standby. If a spare has taken over from this box, reports may be sent twice", "--yes"}};
constexpr Form kLedgerForms[] = {
    {"new", begin_ledger, kNothing,
     "begin another ledger instead of one that cannot be read. Adit keeps its files, but does not know its "
     "reports: one may be sent twice",
     "--yes"},
    {"dump", dump_ledger, kDirectory,
     "print each record of the ledger in DIRECTORY (/var/lib/adit/ledger if not given) as a line of JSON, "
     "without asking Adit"}};
constexpr Form kTestForms[] = {
    {"", test, kNothing, "", "--course --scoring --mapping --scoring-token --mapping-token", true}};
constexpr Form kUpdateForms[] = {
    {"", update, kFileIfAny, "", "--stick --restart --back --stay --again --anyway", true}};
constexpr Form kCompleteForms[] = {
    {"reports", complete_reports, kWord, "list the reports that `adit reports WORD` applies to"},
    {"rejected", complete_rejected, kNothing, "list the rejected messages"},
    {"courses", complete_courses, kNothing, "list the courses"},
    {"runs", complete_runs, kNothing, "list the kept runs"},
    {"tokens", complete_tokens, kNothing, "list the names of tokens"},
    {"alarms", complete_alarms, kNothing, "list the alarms"},
    {"contexts", complete_contexts, kNothing, "list the contexts, without asking Adit", "--at --token-file"},
    {"keys", complete_keys, kKey, "list the settings keys, or the values of KEY, without asking Adit",
     "--at --token-file"}};
constexpr Form kCheckForms[] = {{"", check, kSettingsFile, "", "", true}};

constexpr CommandRow kCommands[] = {
    {"status", "show alarms, run, Command Post, reports and each robot's maps", kStatusForms,
     "Alarms:\n"
     "  x   a fault\n"
     "  ?   the operator must decide\n"
     "  !   may end by itself\n"
     "Column `arriving`:\n"
     "  waiting                  accepted, but not sent so far\n"
     "  up to date, arriving     delivered, or queued for its turn\n"
     "  12 s behind              later than its turn explains\n"
     "  throttled, failing       the last attempt failed; the row says why\n"
     "  not arriving, rejected   attempts have failed for long, or for good\n"
     "  quiet                    all delivered, and no new message for a minute\n"
     "  silent                   the robot has stopped posting\n"
     "The size is that of the last message, as sent.",
     "no alarm is bad or asks", "an alarm is bad or asks",
     "  sudo adit status\n"
     "  adit status --at 10.0.0.1 --token-file team.token\n"
     "  sudo adit status --json | jq '.run.remaining_reports'"},
    {"watch", "show `adit status` continuously", kWatchForms,
     "On a terminal: redraw at most once a second until q or Ctrl-C. In a pipe or a file: print the status "
     "once, then a line for each change. With --json: print the view on one line, at most once a second. If "
     "Adit does not answer, print the error and try again.",
     "you ended it", "",
     "  sudo adit watch\n"
     "  sudo adit watch | tee run.log\n"
     "  sudo adit watch --json | jq --unbuffered '.run.score'"},
    {"alarms", "show the alarms; acknowledge one", kAlarmForms,
     "`adit help status` explains the marks. An acknowledged alarm no longer makes `adit status` exit with "
     "1.",
     "no alarm is bad or asks, or the alarm is acknowledged", "an alarm is bad or asks, or does not exist",
     "  sudo adit alarms\n"
     "  sudo adit alarms acknowledge robot_silent:uav5"},
    {"reports", "list artifact reports; send, hold, withdraw, correct or settle them", kReportForms,
     "Without a subcommand: list the reports of the present run and the unfinished ones of other runs, the "
     "newest first. A report in doubt delays no other report.\n"
     "\n"
     "States (JSON and CSV write in_doubt):\n"
     "  held              Adit sends it only after `adit reports send`; the row gives the reason\n"
     "  held, to be sent  Adit sends it within `reports.undo_s`; withdraw it to undo it\n"
     "  queued            on disk, to be sent in its turn\n"
     "  sending           sent, not yet answered\n"
     "  answered          the Command Post recorded it\n"
     "  rejected          the Command Post rejected it; Adit does not retry\n"
     "  in doubt, asking  the answer was lost. Adit asks the run's status, then settles or retries it\n"
     "  in doubt          the answer was lost, and the run's status does not decide: send it or settle it\n"
     "  settled           the answer was lost; the run's status showed that the report was recorded, or\n"
     "                    the operator settled it\n"
     "  withdrawn         the operator withdrew it, or it repeats an earlier report and got that answer",
     "no report is held or waits for a decision, or the action succeeded",
     "a report is held, or in doubt and for you to decide, or does not exist, or the action was rejected",
     "  sudo adit reports --last 5\n"
     "  sudo adit reports show 14\n"
     "  sudo adit reports send 15 16\n"
     "  sudo adit reports correct 17 type=Backpack y=-3.5\n"
     "  sudo adit reports compose type=Survivor x=12.5 y=-3 z=0.4\n"
     "  sudo adit reports export > reports.csv\n"
     "  sudo adit reports --run all --json | jq -r '.[] | [.number, .type, .state] | @tsv'"},
    {"rejected", "list maps, states and markers that the Command Post rejected", kRejectedForms,
     "A message is listed if the Command Post rejected it (400, 413, 422), or failed at it repeatedly (500) "
     "while others were delivered. Adit also lists maps that it put aside, because three faults ended it "
     "while it packed them. Adit keeps the newest 100.",
     "no message needs a decision, or the action succeeded",
     "a message is listed that no newer one has replaced, or the action was rejected", ""},
    {"run", "show the present run, or begin a new one", kRunForms,
     "Adit detects a new run if the run's name or team changes, more reports are left, or the run clock goes "
     "back. If only the clock shows it, a report that repeats one of the old run is held until an answer "
     "names the run. Otherwise declare it with `adit run new`. Unsent reports of the old run are then held, "
     "and a report that repeats one of an old run is a new report.",
     "the command succeeded", "no run was begun", "  sudo adit run new"},
    {"runs", "list the kept runs; show, print or delete one", kRunsForms,
     "Without a subcommand: list the runs whose map, tracks and plots are kept, the latest first. KEY is the "
     "first column.",
     "the command succeeded", "the run does not exist, or was not deleted",
     "  sudo adit runs\n"
     "  sudo adit runs report 3 --to run-3.html\n"
     "  sudo adit runs --json | jq -r '.runs[] | [.key, .course, .score] | @tsv'"},
    {"settings", "show or change Adit's settings", kSettingsForms,
     "New settings are in use within a second, and cut only connections to a removed address. If Adit cannot "
     "use them, it keeps the old ones, and `adit status` says why.\n"
     "An item of a list is named by its name or its index: robots[ugv1].alias, team.listen[0].port. VALUE is "
     "JSON; a text needs no quotes.",
     "the command succeeded", "the settings are wrong, or somebody else changed them at the same time",
     "  sudo adit settings set reports.review all\n"
     "  sudo adit settings export > box.json\n"
     "  sudo adit settings check box.json && sudo adit settings apply box.json"},
    {"tokens", "show which tokens are set; set or remove one", kTokenForms,
     "Names: scoring, mapping, team, and for each course course.NAME.scoring and course.NAME.mapping. A "
     "token "
     "is never printed.",
     "the command succeeded", "the token does not exist, or was rejected",
     "  sudo adit tokens set mapping\n"
     "  sudo adit tokens set course.A.scoring a-scoring.token\n"
     "  pass adit/team | sudo adit tokens set team"},
    {"password", "set the page's passwords", kPasswordForms,
     "Passwords are typed, or piped into adit, one on each line: the present one, the new one, the new one "
     "again.",
     "the password is set or removed", "it was rejected", "  sudo adit password set viewer"},
    {"course", "list the courses, or switch to another course's Command Post", kCourseForms,
     "Without NAME: list the courses of the settings and mark the one in use. \"\" as NAME switches to the "
     "endpoints of command_post itself.\n"
     "Unfinished reports stay with the old Command Post until you switch back; `adit reports send` sends one "
     "to the new one instead. If the old Command Post never answered, queued reports go to the first that "
     "does.",
     "the command succeeded", "the course does not exist", "  sudo adit course B"},
    {"identify", "flash the box's lights, to tell it from others", kIdentifyForms,
     "All lights flash together, twice a second, for SECONDS (1 to 60; 10 if not given).", "the lights flash",
     "", "  sudo adit identify 30"},
    {"network", "show or change the box's own addresses", kNetworkForms,
     "The box applies a change at once and returns to the old addresses unless you confirm within "
     "network.confirm_within_ms.",
     "no change is to be confirmed, or the action succeeded",
     "a change is to be confirmed, or the action was rejected",
     "  sudo adit network\n"
     "  sudo adit network set team=192.168.8.11/24\n"
     "  sudo adit network confirm --at 192.168.8.11"},
    {"clock", "show or set the box's time of day", kClockForms,
     "After boot a box without a battery continues from the last time that it knew, until the Command Post's "
     "answers, robots' stamps, the page or `adit clock set` set it. While the NTP server of clock.ntp_server "
     "answers, only that server sets it.",
     "the time is set, or is being set", "the time is not set, or setting it failed",
     "  adit clock\n"
     "  adit clock set --at 10.0.0.1 --token-file team.token"},
    {"certificate", "show or replace the page's certificate for HTTPS", kCertificateForms,
     "If a browser shows the same fingerprint (SHA-256), it is connected to this box. The box checks a new "
     "certificate before it uses it, and never shows its key.\n"
     "adit uses no TLS, so the box accepts `set` on its own machine alone. From another one, upload the file "
     "by HTTPS on the page System.",
     "HTTPS is offered, or the certificate is replaced",
     "HTTPS is not offered, or the certificate was rejected",
     "  adit certificate\n"
     "  sudo adit certificate set page.pem"},
    {"test", "test each endpoint of the Command Post; uses up no report", kTestForms,
     "Steps:\n"
     "  link     the Command Post's port has a carrier\n"
     "  address  the port has an address, and no other machine has the same\n"
     "  cables   the two cables are not exchanged\n"
     "  reach    the endpoint accepts a connection\n"
     "  token    the endpoint accepts the token\n"
     "  clock    the box's time of day agrees with the Command Post's, to 2 s\n"
     "Options test an address, a token or a course before you apply it; the run goes on. If one endpoint is "
     "named, only that one is tested.",
     "no step is bad", "a step is bad",
     "  sudo adit test\n"
     "  sudo adit test --scoring 10.100.2.200 --mapping 10.100.2.201\n"
     "  sudo adit test --json | jq '.endpoints[].steps[] | select(.state == \"bad\")'"},
    {"spare", "replace this box by a spare one, without sending a report twice", kSpareForms,
     "Steps:\n"
     "  1. on the first box: adit spare export FILE (or --stick)\n"
     "  2. unplug the first box\n"
     "  3. on the spare, at its own address: adit spare take FILE (or --stick)\n"
     "  4. give the spare the first box's addresses (on the page) and its cables\n"
     "Unsent reports of the first box are in doubt on the spare until the run's status decides, for about 10 "
     "s. Then the spare sends them. The export is encrypted; the code is not part of it.",
     "the box is not on standby and has no export to open, or the action succeeded",
     "the box is on standby or has an export to open, or the action was rejected or not confirmed",
     "  sudo adit spare export /media/stick/box.adit-spare\n"
     "  sudo adit spare take /media/stick/box.adit-spare --code '1234 5678 9012 3456'\n"
     "  adit spare export --stick --at 10.0.0.1 --token-file team.token"},
    {"ledger", "print the ledger's records, or begin another ledger", kLedgerForms,
     "The ledger has all reports and runs, each step of them as a record. A record that is missing is "
     "printed as {\"gap\": ...}.",
     "the command succeeded",
     "a record is missing or damaged, or the ledger can be read, so that Adit begins no other",
     "  sudo adit ledger dump | jq -c '.reports[]?'\n"
     "  sudo adit ledger new"},
    {"update", "show the box's version, or install another", kUpdateForms,
     "Without FILE or an option: show the running version, its slot, and the result of the last update. FILE "
     "is adit-BOARD-VERSION.raucb. The box checks it and installs it in the other slot, which takes some "
     "minutes; reports and maps go on.\n"
     "\n"
     "After a restart the update is on trial until it has been healthy for a minute. If it does not come up "
     "in three starts, the box returns to the version before. Updates of another board, with an unknown "
     "signature, or of an older version are rejected.",
     "the command succeeded",
     "the update was rejected or failed, an unexpected slot runs, a report is queued or being sent, or the\n"
     "     box cannot be updated",
     "  sudo adit update adit-qemu-virt-0.2.0.raucb && sudo adit update --restart"},
    {"reset", "return the box to its initial state", kResetForms,
     "Deletes settings, tokens, passwords and sessions, as the button does. The ledger keeps all reports. "
     "The "
     "operator's present password is needed.",
     "the box is reset", "it was not reset", "  sudo adit reset"},
    {"log", "print the last records of the log", kLogForms,
     "Prints at most 2000 records, the latest last. With --json: a line for each record.",
     "the command succeeded", "",
     "  sudo adit log --level warning\n"
     "  sudo adit log --follow --text mapping"},
    {"bundle", "write the support bundle to a file", kBundleForms,
     "Writes FILE (adit-support.tar.gz if not given): log, settings, reports and state, without tokens and "
     "passwords.",
     "the file is written", "", "  sudo adit bundle /tmp/box.tar.gz"},
    {"login", "save the address and token of an Adit for later commands", kLoginForms,
     "ADDRESS is an address, a name or a URL of a page. The token is in the file of --token-file, in "
     "$ADIT_TOKEN, typed, or piped in. adit checks both, saves them in ~/.config/adit/contexts.json, which "
     "this user alone can read, and asks this Adit from then on.",
     "the context is saved", "Adit rejects the token",
     "  adit login adit.local --token-file team.token\n"
     "  adit login 192.168.8.11 --name spare"},
    {"context", "list the saved contexts; use or remove one", kContextForms,
     "`adit login` saves contexts. A context's name is also accepted by --at.", "the command succeeded",
     "there is no such context",
     "  adit context use spare\n"
     "  adit status --at spare"},
    {"version", "show the versions of adit and of the box", kVersionForms, "", "the command succeeded", "",
     ""},
    {"check", "list all errors of a settings file", kCheckForms,
     "Read SETTINGS (/etc/adit/settings.json if not given) as aditd does, and name each error by the path of "
     "its key. Summarise correct settings, and warn if a Command Post's token does not have 16 characters or "
     "the team's network overlaps the Command Post's.",
     "the settings are correct", "they are wrong",
     "  adit check\n"
     "  adit check new.json && sudo install -m 644 new.json /etc/adit/settings.json"},
    {"complete", "list the words that shells complete", kCompleteForms,
     "Each line is a word, a tab, and its description.", "the command succeeded", "",
     "  adit complete reports send"},
    {"help", "explain a command: adit help COMMAND", {}, "", "", "", ""}};

}  // namespace

std::span<const CommandRow> commands() {
  return kCommands;
}

}  // namespace adit::cli
