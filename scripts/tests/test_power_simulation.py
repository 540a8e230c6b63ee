# SPDX-License-Identifier: Apache-2.0
"""A subsystem whose array is off between frames, by the power intent and the sequence of docs/user/power_intent.md: in Icarus Verilog every
register of the domains that are off is X, and the clamps hold. The subsystem's outputs stay known, and the next frame has the results
of a run that is never off. Planted faults are found: no clamps, lost words of the prior, no ABORT, a START while off."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import upf
from power_intent import Checker
from upf import Design, inside

ROOT = Path(__file__).resolve().parents[2]
INTENT = ROOT / "constraints" / "power_intent" / "dtof_subsystem.upf"
BENCH = Path(__file__).with_name("power_intent_bench.sv")
SIZE = {"SRAM_NUM": 2, "PIXELS_PER_SRAM": 4, "ENGINE_COLUMNS": 2}
HISPOINTER = 2


def isolated(array: str, clamps: dict[str, str]) -> tuple[str, str]:
    """The array's text under another name, and a module of its own name around it, with clamps behind its outputs."""
    text = next(upf.HDL.glob(f"*/{array}.sv")).read_text(encoding="utf-8")
    found = re.search(rf"^module {array}\b.*?\n\);\n", text, re.DOTALL | re.MULTILINE)
    assert found is not None
    head = found.group()
    parameters = re.findall(r"^ +parameter \w+ (\w+) =", head, re.MULTILINE)
    ports = re.findall(r"^ +(input|output) +logic +(\[.*\] )?(\w+),?(?: *//.*)?$", head, re.MULTILINE)
    core = text.replace(head, head.replace(f"module {array}", f"module {array}_core"))
    wires = "".join(f"  logic {width}core_{name};\n  assign {name} = bench.isolate ? '{clamps[name]} : core_{name};\n"
                    for direction, width, name in ports if direction == "output")  # fmt: skip
    settings = ", ".join(f".{name}({name})" for name in parameters)
    connections = ", ".join(f".{name}({'core_' * (direction == 'output')}{name})" for direction, _, name in ports)
    return core, f"`include \"dtof_macros.svh\"\n{head}{wires}  {array}_core #({settings}) u_core ({connections});\nendmodule\n"


def simulated(design: Design, settings: dict[str, str]) -> dict[str, str]:
    """Files: the array with clamps, and SystemVerilog of what the power intent says happens when the array goes off and on again."""
    checker = Checker(upf.execute(INTENT, design, settings), design)
    if problems := checker.run():
        raise AssertionError(problems)
    array = next(path for path, scope in design.scopes.items() if scope.module in upf.ARRAYS)

    def of_bench(path: str) -> str:
        return f"u_dut.{array}.u_core{path[len(array):]}"

    clamps: dict[str, str] = {}
    forced: list[str] = []
    releases: list[str] = []
    lost: list[str] = []
    lost_memories: list[str] = []
    for root, domain in checker.roots.items():
        for port in design.scopes[root].ports:
            for entry in checker.isolation_of(root, port)[:1]:
                if root == array:
                    clamps[port] = entry.one("-clamp_value")[0]
                else:
                    forced.append(f"force {of_bench(inside(root, port))} = {{1024{{1'b{entry.one('-clamp_value')[0]}}}}};")
                    releases.append(f"release {of_bench(inside(root, port))};")
    for path, scope in design.scopes.items():
        domain = checker.domain_of(path)
        if checker.switched(checker.supplies[domain]):
            target = lost_memories if domain.endswith("PD_MEMORY") else lost
            for name, addresses in scope.registers.items():
                register = of_bench(inside(path, name))
                if addresses is None:
                    target.append(f"{{{register}, spare}} = {{1024{{1'bx}}}};")  # alone, a register of an enum would need a cast
                else:
                    target += [f"{register}[{address}] = {{1024{{1'bx}}}};" for address in range(addresses[0], addresses[1] + 1)]
    kept = [of_bench(entry.path(name)) for entry in checker.by_name["set_retention"] for name in entry.one("-elements")]
    saved = [f"saved_{number} = {name};" for number, name in enumerate(kept)]
    restored = [f"{name} = saved_{number};" for number, name in enumerate(kept)]
    bodies = {"clamp": ["isolate = 1'b1;", *forced], "unclamp": ["isolate = 1'b0;", *releases], "corrupt": lost, "corrupt_memories": lost_memories,
              "save": saved, "restore": restored}  # fmt: skip
    variables = "logic isolate = 1'b0, spare;\n" + "".join(f"logic saved_{number};\n" for number in range(len(kept)))
    core, around = isolated(design.scopes[array].module, clamps)
    return {"core.sv": core, "around.sv": around,
            "power_tasks.svh": variables + "".join(f"task {name};\nbegin\n{chr(10).join(body)}\nend\nendtask\n" for name, body in bodies.items())}


class PowerSimulation(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def build(self, readout: int, prior: int) -> Path:
        parameters = {"READOUT": readout, "PRIOR": prior} | SIZE
        design = upf.elaborate("dtof_subsystem", parameters)
        for name, text in simulated(design, {"dtof_prior": str(prior)}).items():
            (self.folder / name).write_text(text, encoding="utf-8")
        replaced = "dtof_pool_pointer_array.sv" if readout == upf.POOL else "dtof_array.sv"
        listed = [file for file in (upf.HDL / "dtof.f").read_text(encoding="utf-8").splitlines() if file.endswith(".sv") and file[0] != "/"]
        of_replaced = [str(self.folder / "core.sv"), str(self.folder / "around.sv")]
        files = [part for file in listed for part in (of_replaced if file.endswith(f"/{replaced}") else [file])]
        program = self.folder / f"bench_{readout}.vvp"
        subprocess.run(["iverilog", "-g2012", "-I", self.folder, "-Icommon", "-s", "bench", f"-Pbench.READOUT={readout}", f"-Pbench.PRIOR={prior}",
                        "-o", program, *files, BENCH], cwd=upf.HDL, check=True)  # fmt: skip
        return program

    def run_bench(self, program: Path, **options: int) -> tuple[str, list[str]]:
        """The verdict, and the words."""
        arguments = [f"+{name}={value}" for name, value in options.items()]
        lines = subprocess.run(["vvp", "-n", program, *arguments], capture_output=True, text=True, timeout=1200).stdout.splitlines()
        verdicts = [line for line in lines if line == "PASS" or "FAIL" in line or "error" in line.lower()]
        return verdicts[0] if verdicts else "no verdict", [line for line in lines if line.startswith("WORD")]

    def test_a_frame_after_the_array_was_off_is_right(self) -> None:
        program = self.build(HISPOINTER, 0)
        verdict, expected = self.run_bench(program)
        self.assertEqual(verdict, "PASS")
        self.assertEqual(self.run_bench(program, off=1), ("PASS", expected))
        for fault in (1, 3, 5):  # no clamps, no ABORT, START while the array is off
            with self.subTest(fault=fault):
                self.assertNotEqual(self.run_bench(program, off=1, fault=fault), ("PASS", expected))

    def test_a_frame_after_the_array_was_off_has_the_prior(self) -> None:
        program = self.build(upf.POOL, 1)
        verdict, expected = self.run_bench(program, prior=1)
        self.assertEqual(verdict, "PASS")
        self.assertEqual(self.run_bench(program, prior=1, off=1), ("PASS", expected))
        verdict, without = self.run_bench(program)
        self.assertEqual(verdict, "PASS")
        self.assertNotEqual(without, expected, "the prior changes nothing here, so the test proves nothing")
        self.assertEqual(self.run_bench(program, off=1), ("PASS", without))
        self.assertEqual(self.run_bench(program, prior=1, off=1, fault=4), ("PASS", without), "the flip-flop is not restored")
        for fault in (1, 2, 3):  # no clamps, the memories lose their words, no ABORT
            with self.subTest(fault=fault):
                self.assertNotEqual(self.run_bench(program, prior=1, off=1, fault=fault), ("PASS", expected))


if __name__ == "__main__":
    unittest.main()
