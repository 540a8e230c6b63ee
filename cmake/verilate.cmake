# SPDX-License-Identifier: Apache-2.0
#
# Verilated models of dtof_array and dtof_pool_pointer_array.
#
#   dtof_verilate(<name> READOUT <read-out> [NP n] [NB n] [PIXELS_PER_SRAM n] [SRAM_NUM n] [SLOTS n]
#                 [COUNT_WIDTH n] [POINTER_STEP n] [FRACTION_BITS n] [CONFIDENCE_WIDTH n] [GUARD n]
#                 [WINDOW_CENTRED 0|1] [POINTER_PORTS 1|2] [SIGNALLED_CLEAR 0|1] [TIME_GATE 0|1] [RAW_HISTOGRAM 0|1] [PROBE]
#                 [WRITABLE_SRAMS] [WAVEFORM] TARGET <library>)
#   dtof_verilate(<name> READOUT poolpointer|poolpointer-lean [NP n] [PIXELS_PER_SRAM n] [SRAM_NUM n] [SLOTS n] [COUNT_WIDTH n]
#                 [GROUP_SIZE n] [LABELS n] [SCORE_BITS n] [OFFSET_BITS n] [ADVANTAGE_WIDTH n] [POINTER_SHIFT n]
#                 [RIVAL_MOVES 0|1] [CELL_SHIFT n] [SECOND_TARGET 0|1] [AMPLITUDE 0|1] [PRIOR 0|1] [ENGINE_COLUMNS n] [COARSE_SHARE n]
#                 [TRACK_SHARE n]
#                 [WRITABLE_SRAMS] [WAVEFORM] TARGET <library>)
#
# and, with SUBSYSTEM [CLOCK_WAITS 0|1] [SOURCE_WAITS 0|1] [BUFFER_LINES n] [RASTER_ORDER 0|1] [SELF_TEST 0|1] [AXI_LITE 0|1] instead of PROBE and what follows it, dtof_subsystem around either,
#
# adds the model to the object library <library> made by dtof_rtl_models(<library> ...). A program that links it
# finds the configuration in the registry of rtl/registry.hpp. Left-out parameters take
# ReadoutParameters::defaults(); <read-out> is the command-line name. Verilator finds the modules by their names, and
# runs again when a file that it read changes; a model is one C++ file.
#
#   dtof_rtl_models(<library> [SELDOM] [BATCH n] [OPTIONS ...])
#
#   dtof_verilate_named(readouts|waveforms|variants <top module> <library>)
#
# adds configurations of configurations.toml (scripts/list_models.py).
#
# WRITABLE_SRAMS makes the SRAMs' contents writable from C++ (rtl/sram.hpp).
#
# WAVEFORM adds the code that records waveforms, which about doubles the compile time of a model. The variable DTOF_WAVEFORMS
# adds it to every model of a folder.
#
# SELDOM: only programs outside of `all` link the library, so that `all` does not build the library either.
#
# BATCH compiles n models in one go: for many small models most of the compiler's time goes to common headers. The models of newer
# versions of Verilator (5.032) have precompiled headers, of which a C++ file may have one: each of these models is compiled alone.

find_program(VERILATOR verilator REQUIRED)
execute_process(COMMAND ${VERILATOR} --getenv VERILATOR_ROOT OUTPUT_VARIABLE VERILATOR_ROOT
                OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
set(VERILATOR_INCLUDE ${VERILATOR_ROOT}/include)
file(STRINGS ${VERILATOR_INCLUDE}/verilated.mk DTOF_VERILATED_PCH REGEX "^VK_PCH_H *=")
find_package(Threads REQUIRED)

set(DTOF_HDL_DIR ${PROJECT_SOURCE_DIR}/hdl CACHE PATH "Folder that holds dtof.f and the SystemVerilog sources")
set(DTOF_HDL_FOLDERS subsystem thesis pool common technology/behavioural)

# Coverage (make coverage): each simulation writes the counts of its RTL (rtl/write_coverage.cpp).
set(DTOF_COVERAGE_FLAGS "")
if(DTOF_COVERAGE)
  set(DTOF_COVERAGE_FLAGS --coverage-line --coverage-toggle)
endif()

# Verilator's runtime, compiled once. Stop, finish, fatal and printing are ours (rtl/verilated_hooks.cpp).
add_library(verilated_runtime STATIC
  ${VERILATOR_INCLUDE}/verilated.cpp
  $<$<BOOL:${DTOF_COVERAGE}>:${VERILATOR_INCLUDE}/verilated_cov.cpp>
  ${VERILATOR_INCLUDE}/verilated_threads.cpp)
set_target_properties(verilated_runtime PROPERTIES POSITION_INDEPENDENT_CODE ON)  # the Python module takes it in
target_include_directories(verilated_runtime SYSTEM PUBLIC ${VERILATOR_INCLUDE} ${VERILATOR_INCLUDE}/vltstd)
target_compile_definitions(verilated_runtime
  PUBLIC VM_COVERAGE=$<BOOL:${DTOF_COVERAGE}> VM_SC=0 VM_TRACE=1 VM_TRACE_FST=1
  PRIVATE VL_USER_STOP VL_USER_FINISH VL_USER_FATAL VL_PRINTF=dtof_verilated_printf)
target_compile_options(verilated_runtime PRIVATE -w $<$<CXX_COMPILER_ID:GNU,Clang>:-fno-semantic-interposition>
  -include ${PROJECT_SOURCE_DIR}/tb_cpp/rtl/verilated_printf.h)
# Its atomic counters are calls to a library where clang compiles them (make fuzz).
target_link_libraries(verilated_runtime PUBLIC Threads::Threads $<$<CXX_COMPILER_ID:Clang>:atomic>)

# The part that writes waveforms.
add_library(verilated_waveform STATIC ${VERILATOR_INCLUDE}/verilated_fst_c.cpp)
target_compile_options(verilated_waveform PRIVATE -w)
target_link_libraries(verilated_waveform PUBLIC verilated_runtime ZLIB::ZLIB)

# -Wno-SYNCASYNCNET: the assertions look at the asynchronous reset in a clocked block.
include(${CMAKE_CURRENT_LIST_DIR}/readouts.cmake)
set(DTOF_VERILATE_DIR ${CMAKE_CURRENT_LIST_DIR})

# What names parameters is compiled apart (<library>_registrations), so that an edit of models/dtof/core compiles no RTL.
function(dtof_rtl_models library)
  cmake_parse_arguments(P "SELDOM" "BATCH" "OPTIONS" ${ARGN})
  add_library(${library} OBJECT)
  target_include_directories(${library} PRIVATE ${PROJECT_SOURCE_DIR}/tb_cpp ${PROJECT_SOURCE_DIR}/models)
  target_compile_options(${library} PRIVATE ${P_OPTIONS} -w)
  target_link_libraries(${library} PUBLIC dtof_rtl)
  add_library(${library}_registrations OBJECT)
  target_link_libraries(${library}_registrations PRIVATE dtof_rtl dtof_subsystem)
  set_target_properties(${library}_registrations PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  target_sources(${library} INTERFACE $<TARGET_OBJECTS:${library}_registrations>)
  set_target_properties(${library} ${library}_registrations PROPERTIES EXCLUDE_FROM_ALL ${P_SELDOM})
  if(P_BATCH AND NOT DTOF_VERILATED_PCH)
    set_target_properties(${library} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE ${P_BATCH})
  endif()
endfunction()

function(dtof_verilate name)
  cmake_parse_arguments(P "PROBE;WRITABLE_SRAMS;WAVEFORM;SUBSYSTEM" "READOUT;TARGET;CLOCK_WAITS;SOURCE_WAITS;BUFFER_LINES;RASTER_ORDER;AXI_LITE;SELF_TEST;${DTOF_PARAMETERS}" ""
    ${ARGN})
  if(P_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "dtof_verilate(${name}): unknown ${P_UNPARSED_ARGUMENTS}")
  endif()
  list(FIND DTOF_READOUTS "${P_READOUT}" P_READOUT_INDEX)
  if(P_READOUT_INDEX LESS 0)
    message(FATAL_ERROR "dtof_verilate(${name}): unknown read-out '${P_READOUT}'")
  endif()

  set(array ${DTOF_TOP_${P_READOUT}})
  set(top_parameters ${DTOF_PARAMETERS_${array}})
  set(overrides "")
  if(P_SUBSYSTEM)
    set(top subsystem_testbench)
    set(top_parameters ${DTOF_PARAMETERS_dtof_array} ${DTOF_PARAMETERS_dtof_pool_pointer_array} COARSE_SHARE TRACK_SHARE)
    set(overrides -GREADOUT=${DTOF_SUBSYSTEM_NUMBER_${P_READOUT}})
    foreach(parameter CLOCK_WAITS SOURCE_WAITS BUFFER_LINES RASTER_ORDER AXI_LITE SELF_TEST)
      if(DEFINED P_${parameter})
        list(APPEND overrides -G${parameter}=${P_${parameter}})
      endif()
    endforeach()
  elseif(array STREQUAL dtof_array)
    set(top dtof_array_testbench)
    set(overrides -GREADOUT=${DTOF_NUMBER_${P_READOUT}})
  else()
    set(top pool_pointer_testbench)
  endif()

  if(NOT DEFINED P_NP)
    set(P_NP ${DTOF_DEFAULT_NP})
  endif()
  if(NOT DEFINED P_SRAM_NUM)
    set(P_SRAM_NUM 8)  # a whole array takes long to compile
  endif()
  if(P_PROBE)
    list(APPEND overrides -GPROBE=1)
  endif()
  set(access "")
  if(P_WRITABLE_SRAMS)
    list(APPEND access ${PROJECT_SOURCE_DIR}/tb_cpp/rtl/writable_srams.vlt)
  endif()
  if(NOT array STREQUAL dtof_array)
    list(APPEND access ${PROJECT_SOURCE_DIR}/tb_cpp/rtl/pairs.vlt)
  endif()
  foreach(parameter ${DTOF_PARAMETERS})
    if(NOT DEFINED P_${parameter})
      set(values ${DTOF_DEFAULT_${parameter}})
      if(DEFINED DTOF_DEFAULT_${parameter}_${P_READOUT})
        set(values ${DTOF_DEFAULT_${parameter}_${P_READOUT}})
      endif()
      list(LENGTH values count)
      set(index 0)
      if(count GREATER 1)
        math(EXPR index "${P_NP} - 3")
      endif()
      list(GET values ${index} P_${parameter})
    endif()
    if(parameter IN_LIST top_parameters)
      list(APPEND overrides -G${parameter}=${P_${parameter}})
    endif()
  endforeach()
  set(P_REGISTRY rtl/registry)
  set(P_REGISTER register_rtl_configuration)
  set(P_BASE ArrayModel)
  set(folder rtl)
  if(P_SUBSYSTEM)
    set(P_WAVEFORM false)
    set(P_REGISTRY subsystem/registry)
    set(P_REGISTER register_subsystem)
    set(P_BASE SubsystemModel)
    set(P_ARRAY subsystem/verilated_subsystem)
    set(P_ARRAY_CLASS VerilatedSubsystem)
    set(folder subsystem)
    set(waveform "")
  elseif(P_WAVEFORM OR DTOF_WAVEFORMS)
    set(P_WAVEFORM true)
    set(P_ARRAY rtl/waveform_array)
    set(P_ARRAY_CLASS WaveformArray)
    set(waveform --trace-fst)
    target_link_libraries(${P_TARGET} PUBLIC verilated_waveform)
  else()
    set(P_WAVEFORM false)
    set(P_ARRAY rtl/verilated_array)
    set(P_ARRAY_CLASS VerilatedArray)
    set(waveform "")
  endif()
  set(P_CLASS V${name})
  set(directory ${CMAKE_CURRENT_BINARY_DIR}/verilated/${name})
  set(maker ${CMAKE_CURRENT_BINARY_DIR}/verilated/${name}_maker.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/tb_cpp/rtl/maker.cpp.in ${maker} @ONLY)
  set(registration ${CMAKE_CURRENT_BINARY_DIR}/verilated/${name}_registration.cpp)
  configure_file(${PROJECT_SOURCE_DIR}/tb_cpp/rtl/registration.cpp.in ${registration} @ONLY)
  set(wrapper ${PROJECT_SOURCE_DIR}/tb_cpp/${folder}/${top}.sv)
  # Relative paths: the model's messages name its sources, and its C++ is to be the same in every checkout.
  file(RELATIVE_PATH hdl ${CMAKE_CURRENT_BINARY_DIR} ${DTOF_HDL_DIR})
  list(TRANSFORM DTOF_HDL_FOLDERS PREPEND ${hdl}/ OUTPUT_VARIABLE modules)
  list(TRANSFORM modules REPLACE "^(.+)$" "-y;\\1")
  file(RELATIVE_PATH relative_wrapper ${CMAKE_CURRENT_BINARY_DIR} ${wrapper})
  add_custom_command(
    OUTPUT ${directory}/model.cpp
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${directory}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${directory}
    COMMAND ${VERILATOR} --cc --top-module ${top} --prefix ${P_CLASS} --Mdir ${directory}
            --assert --x-initial unique --x-assign unique -O3 -Wall -Wno-SYNCASYNCNET +define+DTOF_ASSERT_AS_IF ${waveform} --timescale 1ns/1ps
            ${DTOF_COVERAGE_FLAGS}
            ${overrides} -F ${hdl}/dtof_lint.f +incdir+${hdl}/common ${hdl}/common/dtof_pkg.sv ${hdl}/pool/dtof_pool_pkg.sv
            ${hdl}/subsystem/dtof_registers_pkg.sv
            ${modules} ${access}
            ${relative_wrapper}
    COMMAND ${CMAKE_COMMAND} -D DIRECTORY=${directory} -D MAKER=${maker}
            -P ${DTOF_VERILATE_DIR}/unity.cmake
    DEPENDS ${maker} ${DTOF_VERILATE_DIR}/unity.cmake
    DEPFILE ${directory}/model.d
    COMMENT "Verilating ${name}"
    VERBATIM)
  target_sources(${P_TARGET} PRIVATE ${directory}/model.cpp)
  target_sources(${P_TARGET}_registrations PRIVATE ${registration})
endfunction()

function(dtof_verilate_named kind top library)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/configurations.toml
    ${PROJECT_SOURCE_DIR}/readouts.toml
    ${PROJECT_SOURCE_DIR}/scripts/list_models.py ${PROJECT_SOURCE_DIR}/synth/dtof_synth/configuration.py)
  execute_process(COMMAND ${Python3_EXECUTABLE} -B ${PROJECT_SOURCE_DIR}/scripts/list_models.py ${kind} ${top}
    OUTPUT_VARIABLE models OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  string(REPLACE "\n" ";" models "${models}")
  foreach(model ${models})
    if(DTOF_COVERAGE)  # arrays of few columns: the others run the same lines
      string(REGEX REPLACE "SRAM_NUM [0-9][0-9]+" "SRAM_NUM 4" model "${model}")
    endif()
    separate_arguments(arguments UNIX_COMMAND "${model}")
    list(POP_FRONT arguments name)
    dtof_verilate(${name} ${arguments} TARGET ${library})
  endforeach()
endfunction()
