#include "experiments/command/command.h"

int main(int argc, char** argv) { return farcull::command_line(argc, argv); }
