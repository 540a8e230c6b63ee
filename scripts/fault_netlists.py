#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""`fault_netlists.py FOLDER [READOUT ...]`: writes the netlists that dtof-fault-metrics damages, as FOLDER/READOUT.json and FOLDER/READOUT_parity.json.

Yosys elaborates a small array, maps each of its modules to flip-flops and simple gates, and flattens the array last, so that the name of each
gate has the path of its instance. SRAM macros stay cells. The attributes of the top module say which array the netlist is.
"""

import argparse
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from dtof_synth import program
from dtof_synth.configuration import Configuration, load
from dtof_synth.errors import FlowError
from dtof_synth.mapping import rtl_files

ROOT = Path(__file__).resolve().parent.parent
READOUTS = ("ezpointer", "hispointer", "poolpointer")
COLUMNS = 4
ROWS = 16
GATES = "AND,OR,XOR,MUX,NAND,NOR,XNOR"
BLACK_BOXES = """
(* blackbox *)
module dtof_sram_1r1w #(parameter DEPTH = 16, parameter WIDTH = 8, parameter CFG_WIDTH = 1,
    localparam ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1) (
    input clk_i, input [CFG_WIDTH-1:0] cfg_i, output [CFG_WIDTH-1:0] cfg_o,
    input re_i, input [ADDR_WIDTH-1:0] raddr_i, output [WIDTH-1:0] rdata_o,
    input we_i, input [ADDR_WIDTH-1:0] waddr_i, input [WIDTH-1:0] wdata_i);
endmodule
(* blackbox *)
module dtof_sram_1rw #(parameter DEPTH = 16, parameter WIDTH = 8, parameter PARTS = 1, parameter CFG_WIDTH = 1,
    localparam ADDR_WIDTH = (DEPTH > 2) ? $clog2(DEPTH) : 1) (
    input clk_i, input [CFG_WIDTH-1:0] cfg_i, output [CFG_WIDTH-1:0] cfg_o,
    input en_i, input we_i, input [ADDR_WIDTH-1:0] addr_i, input [PARTS-1:0] wparts_i, input [WIDTH-1:0] wdata_i,
    output [WIDTH-1:0] rdata_o);
endmodule
"""


def small_array(configuration: Configuration, parity: int) -> Configuration:
    """The array that is damaged: one engine, if the read-out has engines."""
    engine = {"ENGINE_COLUMNS": COLUMNS} if configuration.is_pool else {}
    name = f"{configuration.name}_parity" if parity else configuration.name
    return configuration.with_parameters(name, PIXELS_PER_SRAM=ROWS, SRAM_NUM=COLUMNS, PARITY=parity, **engine)


def script(array: Configuration, black_boxes: Path, written: Path) -> str:
    """Commands of Yosys."""
    files = " ".join(str(file) for file in rtl_files(ROOT))
    parameters = " ".join(f"-chparam {name} {value}" for name, value in array.rtl_parameters().items())
    top = array.top
    return f"""
read_verilog -sv -defer -DSYNTHESIS -I{ROOT / "hdl" / "common"} {files}
read_verilog -sv -defer {black_boxes}
hierarchy -check -top {top} {parameters}
synth -noshare -top {top} -run coarse:fine
opt -fast -undriven -fine
techmap
opt -fast
abc -g {GATES}
opt_clean
flatten
opt_expr
opt_merge
opt_clean -purge
check -assert
setattr -mod -set dtof_readout "{array.readout}" {top}
setattr -mod -set dtof_rows {array["PIXELS_PER_SRAM"]} -set dtof_columns {array["SRAM_NUM"]} -set dtof_parity {array["PARITY"]} {top}
write_json {written}
"""


def write(array: Configuration, folder: Path) -> Path:
    """Writes the netlist of an array. FlowError with what Yosys says."""
    black_boxes = folder / f"{array.name}_srams.sv"
    black_boxes.write_text(BLACK_BOXES, encoding="utf-8")
    written, commands = folder / f"{array.name}.json", folder / f"{array.name}.ys"
    commands.write_text(script(array, black_boxes, written), encoding="utf-8")
    try:
        finished = subprocess.run(["yosys", "-q", "-s", commands], check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    except FileNotFoundError:
        raise FlowError("yosys is not installed; scripts/install_packages.sh installs it") from None
    (folder / f"{array.name}.log").write_text(finished.stdout, encoding="utf-8")
    if finished.returncode != 0:
        lines = [line for line in finished.stdout.splitlines() if "ERROR" in line] or ["failed"]
        raise FlowError(f"{array.name}: Yosys: {lines[0].strip()} (see {folder / f'{array.name}.log'})")
    return written


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    parser.add_argument("readouts", nargs="*", default=READOUTS, metavar="READOUT")
    arguments = parser.parse_args()
    configurations = load(ROOT / "configurations.toml")
    try:
        unknown = [name for name in arguments.readouts if name not in configurations]
        if unknown:
            raise FlowError(f"no configuration '{unknown[0]}' in configurations.toml")
        arguments.folder.mkdir(parents=True, exist_ok=True)
        arrays = [small_array(configurations[name], parity) for name in arguments.readouts for parity in (0, 1)]
        with ThreadPoolExecutor(2) as pool:
            for _ in pool.map(lambda array: write(array, arguments.folder), arrays):
                pass
    except (FlowError, OSError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    program.run(main)
