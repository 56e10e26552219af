#include "cli/program.h"

int main(int argc, char** argv) {
    return peelray::run_program(argc, argv);
}
