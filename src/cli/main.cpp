#include "cli/program.h"

int main(int argc, char** argv) { return filum::program(argc, argv); }
