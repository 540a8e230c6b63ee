// SPDX-License-Identifier: Apache-2.0
// The SoC's own RTL, leaf first, relative to hdl/; in hdl/ these read the list, behind dtof.f:
//   verilator --lint-only -Wall -f dtof_lint.f -f dtof.f -f ../examples/soc/soc.f --top-module soc
//   iverilog -g2012 -t null -f dtof.f -f ../examples/soc/soc.f -s soc
../fpga/photon_generator.sv
../fpga/uart_transmitter.sv
../fpga/word_sender.sv
../examples/soc/soc_address_decoder.sv
../examples/soc/soc_apb_master.sv
../examples/soc/soc_scene_registers.sv
../examples/soc/soc.sv
