#include "gateway/options.hpp"

namespace adit::gateway {

command_line::Program command_line_of(Options& options) {
  using command_line::Presence;
  return {
      .name = "aditd",
      .about = "Adit's gateway between a robot team and the Command Post.",
      .rows = {{"--settings", "FILE",
                "read the settings (JSON, version 1) from FILE, unless the state directory holds saved ones; "
                "`adit check FILE` lists the errors in a file",
                &options.settings, Presence::Required},
               {"--secrets", "DIR",
                "read scoring.token, mapping.token, team.token and label.code from DIR, if present; only "
                "their owner may have access (mode 0600)",
                &options.secrets, Presence::Required},
               {"--state", "DIR",
                "keep the ledger of reports in DIR, and the set-up from the page: settings.json and "
                "secrets/, which replace the two above; create DIR if it is absent",
                &options.state, Presence::Required},
               {"--network", "DIR", "read the status of adit-network from DIR", &options.network},
               {"--watch", "DIR",
                "read from DIR which other machines use the box's addresses (adit-network --watch)",
                &options.watch},
               {"--ports", "DIR", "read the ports that the firewall opens from DIR (adit-network --ports)",
                &options.ports},
               {"--update", "DIR",
                "read the status of adit-update, and the newer version that apt has, from DIR",
                &options.update},
               {"--clock", "DIR", "read the status of adit-clock from DIR", &options.clock},
               {"--spare", "DIR", "read the status of adit-spare from DIR", &options.spare},
               {"--board", "FILE",
                "read the board's name and the lines of its lights and button from FILE, if present; they "
                "replace the settings' panel",
                &options.board},
               {"--panel", "SOCKET",
                "use the lights and the button of adit-panel at SOCKET; without it aditd drives them itself, "
                "and the lights do not show if aditd hangs",
                &options.panel},
               {"--notices", "DIR",
                "show the notices in DIR to the operator: one file each, from the programs that start and "
                "watch the box",
                &options.notices},
               {"--block", "DIR",
                "read the health of the state directory's disk from DIR, the kernel's directory of disks by "
                "number",
                &options.block}},
      .ending =
          "Queued messages and sessions survive a restart in $RUNTIME_DIRECTORY, or in the state directory "
          "if that is not set.\nExit status: 0 after SIGTERM or SIGINT, 1 if aditd cannot start (the log "
          "says why), 2 if the command line is wrong.",
      .empty = command_line::EmptyValue::Accepted,
  };
}

}  // namespace adit::gateway
