# SPDX-License-Identifier: Apache-2.0
# One small subsystem of each kind: a pointer with gate, fraction and more columns than a word of the mask, behind APB, its lines in an
# SRAM; a histogram whose clock does not wait and whose buffer holds less than an acquisition, behind AXI4-Lite, and one whose clock does;
# the other read-outs; poolPointer with an odd number of pixels, with and without raster order, with and without a second target, with and
# without amplitudes, and with a prior, one with a clock that does not wait; poolPointer lean. Five have a source that cannot wait: lines
# in registers, in an SRAM, of arrays whose clock does not wait, with a buffer that holds an acquisition and with one that does not, and
# of poolPointer. Most have a self-test, some have none. Each read-out has parity once.
dtof_verilate(subsystem_ez READOUT ezpointer NP 10 FRACTION_BITS 2 PIXELS_PER_SRAM 3 SRAM_NUM 34 TIME_GATE 1
  PARITY 1 SELF_TEST 1 WRITABLE_SRAMS SUBSYSTEM BUFFER_LINES 10 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_his_waits READOUT hispointer NP 8 NB 3 PIXELS_PER_SRAM 4 SRAM_NUM 3 SLOTS 1
  SUBSYSTEM TARGET dtof_subsystem_models)
dtof_verilate(subsystem_his READOUT hispointer NP 8 NB 3 PIXELS_PER_SRAM 5 SRAM_NUM 3 SLOTS 1
  RAW_HISTOGRAM 1 PARITY 1 WRITABLE_SRAMS SUBSYSTEM CLOCK_WAITS 0 BUFFER_LINES 3 AXI_LITE 1 SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_sifh READOUT sifh NP 7 NB 4 PIXELS_PER_SRAM 4 SRAM_NUM 3 TIME_GATE 1 SIGNALLED_CLEAR 1 RAW_HISTOGRAM 1
  PARITY 1 WRITABLE_SRAMS SUBSYSTEM SELF_TEST 1 TARGET dtof_subsystem_models)
foreach(readout hispointer1 fifh threesteps histogram)
  dtof_verilate(subsystem_${readout} READOUT ${readout} NP 7 PIXELS_PER_SRAM 4 SRAM_NUM 2 TIME_GATE 1 RAW_HISTOGRAM 1
    PARITY 1 WRITABLE_SRAMS SUBSYSTEM TARGET dtof_subsystem_models)
endforeach()
dtof_verilate(subsystem_ez_drops READOUT ezpointer NP 8 PIXELS_PER_SRAM 4 SRAM_NUM 2
  SUBSYSTEM SOURCE_WAITS 0 SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_threesteps_drops READOUT threesteps NP 7 PIXELS_PER_SRAM 3 SRAM_NUM 2
  SUBSYSTEM SOURCE_WAITS 0 BUFFER_LINES 17 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_his_drops READOUT hispointer NP 7 PIXELS_PER_SRAM 3 SRAM_NUM 2
  SUBSYSTEM CLOCK_WAITS 0 SOURCE_WAITS 0 SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_fifh_drops READOUT fifh NP 7 PIXELS_PER_SRAM 4 SRAM_NUM 3
  SUBSYSTEM CLOCK_WAITS 0 SOURCE_WAITS 0 BUFFER_LINES 3 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_pool_drops READOUT poolpointer NP 10 PIXELS_PER_SRAM 5 SRAM_NUM 2 ENGINE_COLUMNS 2
  SUBSYSTEM SOURCE_WAITS 0 BUFFER_LINES 4 SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_coarse READOUT coarsehistogram NP 8 PIXELS_PER_SRAM 3 SRAM_NUM 2 SLOTS 4
  PARITY 1 WRITABLE_SRAMS SUBSYSTEM SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_pifh READOUT pifh NP 8 PIXELS_PER_SRAM 3 SRAM_NUM 2
  PARITY 1 WRITABLE_SRAMS SUBSYSTEM RASTER_ORDER 1 SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_pool READOUT poolpointer NP 10 PIXELS_PER_SRAM 9 SRAM_NUM 4 ENGINE_COLUMNS 2 AMPLITUDE 1
  PARITY 1 WRITABLE_SRAMS SUBSYSTEM SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_raster READOUT poolpointer NP 10 PIXELS_PER_SRAM 5 SRAM_NUM 3 ENGINE_COLUMNS 2
  SUBSYSTEM CLOCK_WAITS 0 RASTER_ORDER 1 SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_second READOUT poolpointer NP 10 PIXELS_PER_SRAM 7 SRAM_NUM 4 ENGINE_COLUMNS 2 SECOND_TARGET 1
  AMPLITUDE 1 SUBSYSTEM TARGET dtof_subsystem_models)
dtof_verilate(subsystem_second_raster READOUT poolpointer NP 12 PIXELS_PER_SRAM 6 SRAM_NUM 3 ENGINE_COLUMNS 2 BROADCAST_STAGES 5
  SECOND_TARGET 1 PARITY 1 WRITABLE_SRAMS SUBSYSTEM RASTER_ORDER 1 BUFFER_LINES 16 SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_prior READOUT poolpointer NP 10 PIXELS_PER_SRAM 11 SRAM_NUM 3 ENGINE_COLUMNS 2 AMPLITUDE 1 PRIOR 1 TIME_GATE 1
  PARITY 1 WRITABLE_SRAMS SUBSYSTEM SELF_TEST 1 TARGET dtof_subsystem_models)
dtof_verilate(subsystem_lean READOUT poolpointer-lean NP 10 PIXELS_PER_SRAM 16 SRAM_NUM 4 ENGINE_COLUMNS 4 AMPLITUDE 1
  PARITY 1 WRITABLE_SRAMS SUBSYSTEM SELF_TEST 1 TARGET dtof_subsystem_models)
