// SPDX-License-Identifier: Apache-2.0
#include "commands/commands.hpp"

int main(int argc, char** argv) { return dtof::run_program(dtof::dtof_program(), argc, argv); }
