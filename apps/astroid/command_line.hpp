// The command line: the only file that includes CLI11, which is slow to compile.
#pragma once

namespace astroid {

/// Parses the arguments and runs the command they name. @returns the exit code
int run_command_line(int argc, char** argv);

}  // namespace astroid
