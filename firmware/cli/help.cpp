#include "cli/help.hpp"

namespace adit::cli {
namespace {

constexpr const char* kAll = R"(adit - what the gateway is doing, for a shell and for scripts

USAGE
  adit status  [--json] [--at ADDR:PORT | --settings FILE]
  adit reports [show|send|hold|withdraw|done|resubmit|export] [NUMBER...]
  adit aside   [show|send|discard] [NUMBER...]
  adit run new
  adit settings [show|check|apply|export] [FILE]
  adit course NAME
  adit identify [SECONDS]
  adit network [show|confirm|back]
  adit test
  adit update  [FILE] [--stick | --restart]
  adit check   [--json] [SETTINGS]
  adit help [COMMAND]

COMMANDS
  status    the run, the Command Post, each robot's maps, and what the operator must do
  reports   every artifact report and what became of it; and your word on those that wait for it
  aside     maps, states and markers that the Command Post would not take, and your word on them
  run       tells Adit that a new run begins
  settings  what the running Adit is set to, and changes to it
  course    switches to the Command Post of another course
  identify  makes the box's lights flash, to tell it from others
  network   the box's own addresses, and your word on a change of them that waits
  test      tries each endpoint of the Command Post step by step, and spends no report
  update    the box's version, and the installation of another
  check     all that is wrong with a settings file, at once

OPTIONS
  --at ADDR:PORT     where Adit listens for the team: 10.0.0.1:8000 or [fd00::1]:8000
  --settings FILE    the settings to find that in. If not given, those saved in /var/lib/adit/settings.json, or else
                     /etc/adit/settings.json
  --token-file FILE  what lets you in: a file that holds the team's token or the scoring token. If not given, the
                     first of team.token and scoring.token in /var/lib/adit/secrets and /etc/adit/secrets that can be
                     read (by root)
  --json             for scripts: what Adit itself says, as JSON
  --help             this, or more about a command

EXIT STATUS
  0  all is well
  1  something needs the operator, or the settings are wrong
  2  Adit cannot be reached or wants another token, a file cannot be read, or the command line is wrong

ENVIRONMENT
  NO_COLOR  if set, there is no colour on a terminal either
)";

constexpr const char* kStatus =
    R"(adit status - the run, the Command Post, each robot's maps, and what the operator must do

USAGE
  adit status [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]

WHAT IT SHOWS
  First what needs the operator, then the run as the Command Post last told of it, the two endpoints, how many
  reports are in which state, and a row for each robot and kind of update. Its column 'arriving' says:

    yes      the Command Post took the last one
    late     one has waited for over 10 s
    NO       the Command Post refused the last one, or could not be reached: the row says why
    silent   all has arrived, but the robot has sent nothing new for over 30 s
    not yet  accepted, and nothing has been sent so far

  Times are as of now; bytes are of the last update.

EXIT STATUS
  0  nothing needs the operator
  1  something does, or an endpoint cannot be reached or refuses
  2  Adit cannot be reached or wants another token, or the command line is wrong

EXAMPLES
  sudo adit status
  watch -c -n 1 adit status --at 10.0.0.1:8000 --token-file team.token
  sudo adit status --json | jq '.run.remaining_reports'
)";

constexpr const char* kReports = R"(adit reports - every artifact report and what became of it

USAGE
  adit reports [--run N|all] [--json]
  adit reports show NUMBER [--json]
  adit reports send NUMBER...
  adit reports hold NUMBER...
  adit reports withdraw NUMBER...
  adit reports done NUMBER...
  adit reports resubmit NUMBER
  adit reports export [--csv | --json]
  All take --token-file FILE, and --at ADDR:PORT or --settings FILE; those that change something take --json.

WHAT IT SHOWS
  A row for each report of the present run, and for those of other runs that are not finished, the newest
  first; with --run those of one run or of all. A line at the end says how many there are of other runs that
  are not listed: of earlier ones, and of those at other Command Posts. 'show' tells all of one report: its history, the answer that is
  kept, and what you can do. 'export' writes all reports of all runs, as CSV for a spreadsheet or as JSON.

THE STATES (as the JSON and the CSV name them, where that is another word)
  held              waits for your word before it is sent; the row says why: a near duplicate, the review of all
                    reports, a new run, too many failures, or you hold it (received)
  waiting           kept on disk; it is sent when its turn comes
  sending           on its way
  answered          the Command Post recorded it and said so
  refused           the Command Post did not record it, and asking again is no use
  in doubt, asking  it may have been recorded, but its answer was lost. Adit asks the run's status until it is
                    clear, and then settles it or sends it again by itself: there is nothing for you to do
  in doubt          it may have been recorded, and the run's status cannot tell: only you can decide
  settled           its answer was lost, and the run's status showed that it was recorded
  called done       you said that nothing is left to do about it (settled)
  withdrawn         taken back before it was sent
  same as 3         it is report 3 over again, and got that one's answer (withdrawn)

YOUR WORD
  send      a held report: it is meant. One in doubt: only where you know that it was not recorded (ask the
            Command Post, or look at its count of reports), for else it uses up a second one of the allotment.
            A refused or withdrawn one: try it all the same
  hold      a waiting report: it goes only when you send it
  withdraw  a held or waiting report: it is not to be sent. It can still be sent later
  done      a report in doubt that was recorded, or that is not worth a second one of the allotment
  resubmit  a finished report once more on purpose, as a new one with a number of its own
  A report in doubt holds up no other: take your time.

EXIT STATUS
  0  no report waits for your word; of your word: all is done
  1  one does (held, or in doubt); of your word: a report is not there, or is where that cannot be said of it
  2  Adit cannot be reached or wants another token, there is no such report to show, or the command line is wrong

EXAMPLES
  sudo adit reports
  sudo adit reports show 14
  sudo adit reports done 14
  sudo adit reports send 15 16
  sudo adit reports export > reports.csv
  sudo adit reports --run all --json | jq -r '.[] | [.number, .type, .state] | @tsv'
)";

constexpr const char* kRun = R"(adit run - tells Adit that a new run begins

USAGE
  adit run new [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]

WHAT IT DOES
  Adit notices a new run by itself where the run's name or the team changes, where more reports are left than
  before, or where a run clock that was seen to run goes back. Where only that clock tells of it, the same report
  as one of the run before is held until an answer names the run. Where Adit cannot notice it (the next run went
  on from the same clock), this declares it. Reports that were not sent before are held, so that none of the old
  run is sent into the new one unless you say so: adit reports send. The same report as one of an earlier run is
  then a new report.

EXIT STATUS
  0  a new run has begun
  2  Adit cannot be reached or wants another token, or the command line is wrong

EXAMPLES
  sudo adit run new
)";

constexpr const char* kSettings = R"(adit settings - what the running Adit is set to, and changes to it

USAGE
  adit settings [show]      [--json]
  adit settings check FILE  [--json]
  adit settings apply FILE  [--json]
  adit settings export
  All take --token-file FILE, and --at ADDR:PORT or --settings FILE.

WHAT IT DOES
  show    the settings that differ from what is by default, and which tokens are set; with --json all, and what each
          key means
  check   what is wrong with FILE, or what it would change and what to mind. Nothing is changed
  apply   saves FILE on the box and applies it at once: within a second it is in use, and nobody is cut but who is
          connected to an address that goes. Where the new settings cannot be used, those before are in use still, and
          'adit status' says why
  export  the whole settings file, for 'apply'. Tokens are never in it

EXIT STATUS
  0  all is well
  1  something is wrong with FILE, or somebody else changed the settings at the same time
  2  Adit cannot be reached or wants another token, FILE cannot be read, or the command line is wrong

EXAMPLES
  sudo adit settings export > box.json
  sudo adit settings check box.json && sudo adit settings apply box.json
)";

constexpr const char* kCourse = R"(adit course - switches to the Command Post of another course

USAGE
  adit course NAME [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]

WHAT IT DOES
  NAME is one of the courses in the settings; "" means none, the endpoints of command_post itself. It says how many
  reports wait, are in doubt or are held: they are kept for the run at the old endpoint, and none of them is sent to
  the new one unless you say so (adit reports send). Back there, that run is taken up again with its reports: what
  waits goes, what is in doubt is found out, and the same report again gets the recorded answer. Where nothing was
  heard from the old endpoint (a mistyped address), what waits is sent to the first that answers.

EXIT STATUS
  0  the course is in use
  1  there is no such course
  2  Adit cannot be reached or wants another token, or the command line is wrong

EXAMPLES
  sudo adit course B
)";

constexpr const char* kIdentify = R"(adit identify - makes the box's lights flash, to tell it from others

USAGE
  adit identify [SECONDS] [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]

WHAT IT DOES
  All lights flash twice a second, together, for SECONDS (1 to 60; 10 if not given): no condition shows that.
  Then they show again how things stand.

EXIT STATUS
  0  they flash
  2  Adit cannot be reached or wants another token, or the command line is wrong

EXAMPLES
  sudo adit identify 30
)";

constexpr const char* kAside =
    R"(adit aside - maps, states and markers that the Command Post would not take, and your word on them

USAGE
  adit aside [show]           [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]
  adit aside send    NUMBER...
  adit aside discard NUMBER...

WHAT IT SHOWS
  Each message that was set aside: because the Command Post refused it (400, 413, 422), or because it failed at it
  again and again (500) while others passed. They are kept, the newest hundred, until you say what becomes of them.

WHAT IT DOES
  send     sends it once more, when its turn comes. Adit does not where something newer that says all of it was sent
           since: that would put the older in its place.
  discard  forgets it.

EXIT STATUS
  1  something is set aside that nothing newer has replaced, or your word could not be done
)";

constexpr const char* kNetwork =
    R"(adit network - the box's own addresses, and your word on a change of them that waits

USAGE
  adit network [show|confirm|back] [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]

WHAT IT DOES
  'show' tells which addresses the box has on its two sides, and which change waits to be confirmed. A change is
  made on the page. It is tried at once, and takes itself back unless it is confirmed in time
  (network.confirm_within_ms), so that a wrong address costs a minute and not the box.

YOUR WORD
  confirm  the change is good and stays. It must be said at the new address, as what reaches Adit there shows
           that the address works: adit finds it by team.interface, or name it by --at
  back     the change is taken back now

EXIT STATUS
  0  no change waits; of your word: it is done
  1  a change waits; of your word: none waits, or it cannot be said there
  2  Adit cannot be reached or wants another token, or the command line is wrong

EXAMPLES
  sudo adit network
  sudo adit network confirm --at 192.168.8.11:8000
)";

constexpr const char* kTest =
    R"(adit test - tries each endpoint of the Command Post step by step, and spends no report

USAGE
  adit test [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]

WHAT IT TRIES
  link     does the interface to the Command Post have a carrier
  address  does it have an address, and does anybody else on its network have the same
  cables   is the Command Post's network at its own port, and not at the team's
  reach    does the endpoint take a connection
  token    does it take the token
  clock    does the box's clock agree with the Command Post's, to 2 s
  Each step is good, BAD or skipped, with what was found, and with what to do about it.

EXIT STATUS
  0  no step is bad
  1  one is
  2  Adit cannot be reached or wants another token, or the command line is wrong

EXAMPLES
  sudo adit test
  sudo adit test --json | jq '.endpoints[].steps[] | select(.state == "bad")'
)";

constexpr const char* kUpdate =
    R"(adit update - the box's version, and the installation of another

USAGE
  adit update [FILE] [--again] [--json] [--token-file FILE] [--at ADDR:PORT | --settings FILE]
  adit update --stick [--again]
  adit update --restart [--anyway]

WHAT IT DOES
  Without a word it tells which version runs, in which of the two slots, and what became of the last update. FILE is
  an update, adit-BOARD-VERSION.raucb: it is sent to the box, checked there, and installed into the slot that does
  not run. That takes some minutes, and all goes on meanwhile.

    --stick    installs the update that is on the USB stick in the box
    --restart  starts the box anew, to use what was installed. Not while a report waits or is being sent, unless
    --anyway   is said: it is not lost, but its answer has to be found out afterwards
    --again    installs the version that runs already

  What is installed is on trial: it stays once it has been healthy for a minute; where it does not come up in three
  starts, the box goes back to the version before by itself. Another board's update, one that is not signed with a
  key that the box knows, and an older version are refused.

EXIT STATUS
  0  all is well
  1  the update was refused, failed or was left; a report is under way; nothing can be updated here
  2  Adit cannot be reached or wants another token, FILE cannot be read, or the command line is wrong

EXAMPLES
  sudo adit update adit-qemu-virt-0.2.0.raucb && sudo adit update --restart
)";

constexpr const char* kCheck = R"(adit check - all that is wrong with a settings file, at once

USAGE
  adit check [--json] [SETTINGS]

WHAT IT DOES
  Reads SETTINGS (/etc/adit/settings.json if not given) exactly as aditd would, and names each error by the path
  of its key, with what was expected and what was found. Of good settings it says what they come to. It neither
  asks nor changes a running Adit.

EXIT STATUS
  0  aditd would take the file
  1  it would not
  2  the file cannot be read, or the command line is wrong

EXAMPLES
  adit check
  adit check new.json && sudo install -m 644 new.json /etc/adit/settings.json
)";

}  // namespace

const char* const kSeeHelp = "Try 'adit --help'.\n";

const char* help_about(Command command) {
  switch (command) {
    case Command::Status:
      return kStatus;
    case Command::Reports:
      return kReports;
    case Command::Aside:
      return kAside;
    case Command::Run:
      return kRun;
    case Command::Settings:
      return kSettings;
    case Command::Course:
      return kCourse;
    case Command::Identify:
      return kIdentify;
    case Command::Network:
      return kNetwork;
    case Command::Test:
      return kTest;
    case Command::Update:
      return kUpdate;
    case Command::Check:
      return kCheck;
    case Command::Help:
      break;
  }
  return kAll;
}

}  // namespace adit::cli
