# SPDX-License-Identifier: Apache-2.0
# Joins the C++ files that Verilator wrote into DIRECTORY, and REGISTRATION, into one translation unit.
file(GLOB sources ${DIRECTORY}/V*.cpp)
list(SORT sources)
set(text "")
foreach(source ${sources} ${REGISTRATION})
  string(APPEND text "#include \"${source}\"\n")
endforeach()
file(WRITE ${DIRECTORY}/model.cpp "${text}")
