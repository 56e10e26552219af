// The command line: parsing, the subcommands, exit status.
#pragma once

namespace peelray {

/// Runs the program. Returns its exit status: 0 done; 1 the input or the device is at fault (one line on standard
/// error); 2 wrong usage.
int run_program(int argc, const char* const* argv);

}  // namespace peelray
