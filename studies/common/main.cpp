// SPDX-License-Identifier: Apache-2.0
#include "common/commands.hpp"

int main(int argc, char** argv) { return dtof::run_program(dtof::study_program(), argc, argv); }
