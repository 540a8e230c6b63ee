# SPDX-License-Identifier: Apache-2.0
# Joins the C++ files that Verilator wrote into DIRECTORY, and MAKER, which makes an object of the model, into one translation unit. What runs
# once (construction) or on demand (waveform) is not worth the optimiser's time: it would take longer than the rest. It
# stands last, so that no header is read without the optimiser.
# model.d has the files that Verilator read, for the build.
file(GLOB sources ${DIRECTORY}/V*.cpp)
list(SORT sources)
set(rare ${sources})
list(FILTER rare INCLUDE REGEX "(Slow|__Syms|__Trace__[0-9]+|__ConstPool_[0-9]+)\\.cpp$")
list(REMOVE_ITEM sources ${rare})
# Verilator's one file-local name, renamed so that several models fit into one translation unit.
cmake_path(GET DIRECTORY FILENAME name)
set(text "#define trace_init trace_init_${name}\n")
foreach(source ${sources})
  string(APPEND text "#include \"${source}\"\n")
endforeach()
string(APPEND text "#pragma GCC push_options\n#pragma GCC optimize(\"O0\")\n")
foreach(source ${rare})
  string(APPEND text "#include \"${source}\"\n")
endforeach()
string(APPEND text "#pragma GCC pop_options\n#undef trace_init\n#include \"${MAKER}\"\n")
file(WRITE ${DIRECTORY}/model.cpp "${text}")

file(GLOB read ${DIRECTORY}/V*__ver.d)
file(READ ${read} rule)
string(REGEX REPLACE "^.* : " "${DIRECTORY}/model.cpp: " rule "${rule}")
file(WRITE ${DIRECTORY}/model.d "${rule}")
