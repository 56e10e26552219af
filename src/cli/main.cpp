#include <csignal>

#include "cli/program.h"

int main(int argc, char** argv) {
    // A file beyond the process's size limit then fails like a full disk: with a line, and tidied up.
    std::signal(SIGXFSZ, SIG_IGN);
    return peelray::run_program(argc, argv);
}
