#include "emulator/cli.h"

int main(int argc, char** argv) { return hilcam::run_command_line(argc, argv); }
