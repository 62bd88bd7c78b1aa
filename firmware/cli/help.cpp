#include "cli/help.hpp"

namespace adit::cli {
namespace {

constexpr const char* kAll = R"(adit - what the gateway is doing, for a shell and for scripts

USAGE
  adit status  [--json] [--at ADDR:PORT | --settings FILE]
  adit reports [--json] [--at ADDR:PORT | --settings FILE]
  adit check   [--json] [SETTINGS]
  adit help [COMMAND]

COMMANDS
  status   the run, the Command Post, each robot's maps, and what the operator must do
  reports  every artifact report and what became of it
  check    all that is wrong with a settings file, at once

OPTIONS
  --at ADDR:PORT   where Adit listens for the team: 10.0.0.1:8000 or [fd00::1]:8000
  --settings FILE  the settings to find that in; /etc/adit/settings.json if not given
  --json           for scripts: what Adit itself says, as JSON
  --help           this, or more about a command

EXIT STATUS
  0  all is well
  1  something needs the operator, or the settings are wrong
  2  Adit cannot be reached, a file cannot be read, or the command line is wrong

ENVIRONMENT
  NO_COLOR  if set, there is no colour on a terminal either
)";

constexpr const char* kStatus =
    R"(adit status - the run, the Command Post, each robot's maps, and what the operator must do

USAGE
  adit status [--json] [--at ADDR:PORT | --settings FILE]

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
  2  Adit cannot be reached, or the command line is wrong

EXAMPLES
  adit status
  watch -c -n 1 adit status --at 10.0.0.1:8000
  adit status --json | jq '.run.remaining_reports'
)";

constexpr const char* kReports = R"(adit reports - every artifact report and what became of it

USAGE
  adit reports [--json] [--at ADDR:PORT | --settings FILE]

WHAT IT SHOWS
  A row for each report, the newest first: its number, type and position, its state, the points it gained, what
  the Command Post said, and who sent it how long ago. The states:

    waiting   kept on disk; it is sent when its turn comes
    sending   on its way
    answered  the Command Post recorded it
    refused   the Command Post did not record it, and asking again is no use
    in doubt  it may have arrived, but its answer was lost. Adit will not send it again by itself

EXIT STATUS
  0  no report is in doubt
  1  one is
  2  Adit cannot be reached, or the command line is wrong

EXAMPLES
  adit reports
  adit reports --json | jq -r '.[] | [.number, .type, .state] | @tsv'
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
    case Command::Check:
      return kCheck;
    case Command::Help:
      break;
  }
  return kAll;
}

}  // namespace adit::cli
