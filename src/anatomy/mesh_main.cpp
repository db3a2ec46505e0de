#include "anatomy/mesh_program.h"

int main(int argc, char** argv) { return filum::mesh_program(argc, argv); }
