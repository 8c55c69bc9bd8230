#pragma once

#include <string>

namespace evit::procman {

/// One command of a deployment: what it is and how it is to be stopped.
struct ProcmanCommand {
  std::string id;
  std::string exec;              // command line, see SplitCommandLine
  std::string deputy;            // who runs it
  std::string group;             // "a/b": group b inside group a; empty: none
  bool auto_respawn = false;     // restarted when it ends by itself
  int stop_signal = 2;           // SIGINT
  double stop_time_allowed = 7;  // s from that signal to SIGKILL
};

}  // namespace evit::procman
