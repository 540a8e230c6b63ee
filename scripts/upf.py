# SPDX-License-Identifier: Apache-2.0
"""What a power intent is compared with, and what it says: the elaborated RTL by Icarus Verilog, with the values of an array's outputs between
frames, and the UPF commands, which Yosys's Tcl interpreter executes. The reader refuses commands and options that it does not know."""

import re
import subprocess
import tempfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent
HDL = ROOT / "hdl"
POOL = 64  # READOUT of dtof_subsystem around dtof_pool_pointer_array
ARRAYS = ("dtof_array", "dtof_pool_pointer_array")
OPTIONS: dict[str, tuple[int, set[str], set[str]]] = {  # positional arguments, options with a value, flags
    "upf_version": (1, set(), set()),
    "create_supply_port": (1, {"-direction"}, set()),
    "create_supply_net": (1, set(), set()),
    "connect_supply_net": (1, {"-ports"}, set()),
    "create_supply_set": (1, {"-function"}, set()),
    "create_logic_port": (1, {"-direction"}, set()),
    "create_logic_net": (1, set(), set()),
    "connect_logic_net": (1, {"-ports"}, set()),
    "create_power_domain": (1, {"-elements", "-supply"}, set()),
    "create_power_switch": (1, {"-domain", "-input_supply_port", "-output_supply_port", "-control_port", "-on_state", "-off_state"}, set()),
    "set_isolation": (1, {"-domain", "-elements", "-applies_to", "-clamp_value", "-isolation_supply_set", "-isolation_signal",
                          "-isolation_sense", "-location"}, set()),
    "set_retention": (1, {"-domain", "-elements", "-retention_supply_set", "-save_signal", "-restore_signal"}, set()),
    "add_power_state": (1, {"-state"}, {"-complete"}),
}  # fmt: skip
RECORDER = r"""
set record [open {@RECORD@} w]
set scope {}
set instances {@INSTANCES@}
proc record {command arguments} {
  set texts [list $::scope $command]
  foreach argument $arguments {
    set parts {}
    foreach part $argument { lappend parts [string map [list \n { }] $part] }
    lappend texts [join $parts \x1e]
  }
  puts $::record [join $texts \x1f]
}
foreach command {@COMMANDS@} { proc $command {args} "record $command \$args" }
proc find_objects {from args} {
  array set option $args
  if {$from ne {.} || $option(-object_type) ne {inst} || $option(-transitive) ne {TRUE}} { error "find_objects $from $args" }
  set found {}
  foreach instance $::instances {
    if {$::scope ne {}} {
      if {[string first $::scope/ $instance] != 0} { continue }
      set instance [string range $instance [string length $::scope/] end]
    }
    if {[string match $option(-pattern) [lindex [split $instance /] end]]} { lappend found $instance }
  }
  return $found
}
proc load_upf {file option scope} {
  if {$option ne {-scope} || $scope ni $::instances} { error "load_upf: no instance $scope" }
  set outer $::scope
  set ::scope $scope
  uplevel #0 [list source $file]
  set ::scope $outer
}
@SETTINGS@
source {@FILE@}
close $record
"""


class IntentError(Exception):
    """The file cannot be executed, or the RTL not elaborated."""


@dataclass
class Scope:
    """A module instance or a generate block (without a module)."""

    module: str = ""
    ports: dict[str, str] = field(default_factory=dict)    # INPUT or OUTPUT
    sources: dict[str, str] = field(default_factory=dict)  # what drives a net
    registers: dict[str, tuple[int, int] | None] = field(default_factory=dict)  # also memories, with the first and the last address


@dataclass
class Design:
    top: str
    scopes: dict[str, Scope]  # by path: the names, with dots; "" is the top
    idle: dict[str, str]      # by path of a port of the array or of its memories: bits between frames, x where they have no fixed value

    def instances(self) -> list[str]:
        return [path for path, scope in self.scopes.items() if scope.module]

    def upf_path(self, path: str, separator: str) -> str:
        """As a tool writes it that puts `separator` behind a generate block."""
        text, name = "", ""
        for part in path.split("."):
            joint = "" if not name else "/" if self.scopes[name].module else separator
            name = f"{name}.{part}" if name else part
            text += joint + part
        return text


class Command(NamedTuple):
    scope: str  # path of the instance, with dots
    name: str
    positional: list[str]
    options: dict[str, list[list[str]]]  # every value of an option, as a list

    def one(self, option: str) -> list[str]:
        values = self.options.get(option, [[]])
        return values[0]

    def path(self, name: str) -> str:
        return inside(self.scope, name)


def inside(scope: str, name: str) -> str:
    """Path of a name in a scope; a dot alone is the scope."""
    if name == ".":
        return scope
    return f"{scope}.{name}".lstrip(".").replace("/", ".")


def _compile(folder: Path, top: str, parameters: dict[str, int], *benches: Path) -> Path:
    program = folder / f"{top}.vvp"
    settings = [f"-P{top}.{name}={value}" for name, value in parameters.items()]
    done = subprocess.run(["iverilog", "-g2012", "-o", program, "-s", top, *settings, "-f", "dtof.f", *benches], cwd=HDL, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
    if done.returncode != 0:
        raise IntentError(done.stdout)
    return program


def scopes_of(text: str, top: str) -> dict[str, Scope]:
    """Scopes of the top from Icarus Verilog's output."""
    paths: dict[str, str] = {}
    scopes: dict[str, Scope] = {}
    names: dict[str, tuple[Scope, str, tuple[int, int] | None]] = {}
    here = Scope()
    for line in text.splitlines():
        if found := re.match(r'(S_\w+) \.scope (\w+)[\w.]*, "([^"]+)" "([^"]+)".*?(?:, (S_\w+))?;$', line):
            identity, kind, name, module, parent = found.groups()
            here = Scope(module if kind == "module" else "")
            if kind in ("module", "generate") and (parent in paths or (parent is None and name == top)):
                paths[identity] = "" if parent is None else inside(paths[parent], name)
                scopes[paths[identity]] = here
        elif found := re.match(r' +\.port_info \d+ /(\w+) \d+ "(\w+)"', line):
            here.ports[found[2]] = found[1]
        elif found := re.match(r'(v\w+?)(?:_0)? \.(net|var|array)\S* "(\w+)", (.*)$', line):
            bounds = re.match(r"(\d+) (\d+), ", found[4]) if found[2] == "array" else None
            ends = sorted(map(int, bounds.groups())) if bounds else []  # Icarus Verilog 12 writes the last address first
            names[found[1]] = (here, found[3], (ends[0], ends[1]) if bounds else None)
            if found[2] == "net":
                here.sources[found[3]] = re.findall(r"\w+0x\w+", found[4])[0] if "0x" in found[4] else ""
            elif found[2] == "var":
                here.sources[found[3]] = found[1]
        elif found := re.match(r" +%assign/\S+ (v\w+?)(?:_0)?, ", line):
            scope, name, addresses = names[found[1]]
            scope.registers[name] = addresses
    return scopes


def idle_values(folder: Path, top: str, parameters: dict[str, int], scopes: dict[str, Scope]) -> dict[str, str]:
    """Ports' values in reset and after a frame without acquisitions; x where they differ, or where Icarus Verilog has an x."""
    watched = [name for name, direction in scopes[""].ports.items() if direction == "OUTPUT"]
    watched += [f"{path}.{name}" for path, scope in scopes.items() if scope.module == "dtof_sram"
                for name, direction in scope.ports.items() if direction == "INPUT" and name.endswith("en_i")]  # fmt: skip
    inputs = [name for name, direction in scopes[""].ports.items() if direction == "INPUT"]
    given = {"clk_i": "clk", "rst_ni": "rst_n", "start_i": "start", "sram_cfg_i": "'1", "result_tready_i": "1'b1"}
    connections = ", ".join(f".{name}({given.get(name, chr(39) + '0')})" for name in inputs)
    shown = "\n".join(f'      $display("VALUE {name} %b", u_dut.{name});' for name in watched)
    bench = folder / "bench.sv"
    bench.write_text(f"""
module bench;
  logic clk = 1'b0, rst_n = 1'b0, start = 1'b0;
  {top} #({", ".join(f".{name}({value})" for name, value in parameters.items())}) u_dut ({connections});
  always #5 clk = !clk;
  task show;
    begin
{shown}
    end
  endtask
  initial begin
    repeat (10) @(negedge clk);
    show;
    rst_n = 1'b1;
    repeat (10) @(negedge clk);
    start = 1'b1;
    @(negedge clk) start = 1'b0;
    while (!u_dut.done_o) @(negedge clk);
    repeat (10) @(negedge clk);
    show;
    $finish;
  end
  initial #10000000 $fatal(1, "the frame does not end");
endmodule
""", encoding="utf-8")  # fmt: skip
    program = _compile(folder, "bench", {}, bench)
    done = subprocess.run(["vvp", "-n", program], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    values: dict[str, list[str]] = {}
    for name, bits in re.findall(r"^VALUE (\S+) ([01xz]+)$", done.stdout, re.MULTILINE):
        values.setdefault(name, []).append(bits)
    if set(values) != set(watched) or any(len(bits) != 2 for bits in values.values()):
        raise IntentError(f"no values of an idle {top}: {done.stdout[-500:]}")
    return {name: "".join(a if a == b else "x" for a, b in zip(first, second, strict=True)) for name, (first, second) in values.items()}


def elaborate(top: str, parameters: dict[str, int]) -> Design:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scopes = scopes_of(_compile(folder, top, parameters).read_text(encoding="utf-8"), top)
        arrays = [path for path, scope in scopes.items() if scope.module in ARRAYS]
        if len(arrays) != 1:
            raise IntentError(f"{top} has {len(arrays)} arrays")
        array = scopes[arrays[0]].module
        alone = parameters
        if array != top:
            of_array = set(re.findall(r"parameter int (\w+)", next(HDL.glob(f"*/{array}.sv")).read_text(encoding="utf-8")))
            alone = {name: value for name, value in parameters.items() if name in of_array and (name, value) != ("READOUT", POOL)}
        array_scopes = {path[len(arrays[0]):].lstrip("."): scope for path, scope in scopes.items()
                        if path == arrays[0] or path.startswith(f"{arrays[0]}.".lstrip("."))}  # fmt: skip
        idle = idle_values(folder, array, alone, array_scopes)
        return Design(top, scopes, {inside(arrays[0], name): bits for name, bits in idle.items()})


def execute(file: Path, design: Design, settings: dict[str, str], separator: str = ".") -> list[Command]:
    """The UPF commands of the file, in order."""
    paths = {design.upf_path(path, separator): path for path in design.instances()}
    with tempfile.TemporaryDirectory() as name:
        script, record = Path(name) / "run.tcl", Path(name) / "record"
        text = RECORDER
        for key, value in {
            "RECORD": str(record), "INSTANCES": " ".join(f"{{{path}}}" for path in paths if path), "COMMANDS": " ".join(OPTIONS),
            "SETTINGS": "\n".join(f"set {key} {{{value}}}" for key, value in (settings | {"dtof_separator": separator}).items()),
            "FILE": str(file),
        }.items():  # fmt: skip
            text = text.replace(f"@{key}@", value)
        script.write_text(text, encoding="utf-8")
        done = subprocess.run(["yosys", "-Q", "-T", "-c", script], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        if done.returncode != 0:
            raise IntentError(done.stdout.strip())
        lines = record.read_text(encoding="utf-8").split("\n")[:-1]
    return [command(line.split("\x1f"), paths) for line in lines]


def command(texts: list[str], paths: dict[str, str]) -> Command:
    scope, name, *arguments = texts
    number, valued, flags = OPTIONS[name]
    positional: list[str] = []
    options: dict[str, list[list[str]]] = {}
    waiting = iter(arguments)
    for argument in waiting:
        if argument in flags:
            options[argument] = [[]]
        elif argument in valued:
            options.setdefault(argument, []).append(next(waiting, "").split("\x1e"))
        elif argument.startswith("-"):
            raise IntentError(f"{name}: unknown option {argument}")
        else:
            positional.append(argument)
    if len(positional) != number:
        raise IntentError(f"{name} {' '.join(positional)}: {number} name expected")
    return Command(paths[scope], name, positional, options)
