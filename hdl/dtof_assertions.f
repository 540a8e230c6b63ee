// SPDX-License-Identifier: Apache-2.0
// Behind dtof.f, for simulators with concurrent assertions (commercial ones, Verilator 5): the protocols of the ports as assertions and
// covers, bound to every array, subsystem and two-clock FIFO. Icarus Verilog and Yosys have none.
//   verilator --binary --assert --coverage-user -f dtof.f -f dtof_assertions.f my_bench.sv
assertions/dtof_stream_protocol.sv
assertions/dtof_apb_protocol.sv
assertions/dtof_array_protocol.sv
assertions/dtof_reset_length.sv
assertions/dtof_bind.sv
