# SPDX-License-Identifier: Apache-2.0
"""FuseSoC, Bender and Vivado are not in Debian. What they do with their files is done here: the files that a target names are
copied to a folder, and the target's tool reads them there."""

import copy
import re
import shutil
import subprocess
import tempfile
import unittest
from collections.abc import Set
from pathlib import Path

import yaml

import file_lists
from dtof_synth.errors import FlowError

ROOT = Path(__file__).resolve().parents[2]
HDL = ROOT / "hdl"
CORE = yaml.safe_load((ROOT / "dtof.core").read_text(encoding="utf-8").removeprefix("CAPI=2:\n"))
BENDER = yaml.safe_load((ROOT / "Bender.yml").read_text(encoding="utf-8"))
CONDITIONAL = re.compile(r"(!?)(\w+)\? \((.+)\)")
# CAPI2 as FuseSoC's own schema has it (capi2/json_schema.py), as far as dtof.core uses it: the keys of each place with their types, the keys
# that must be there, and the values of those that have a list.
SCHEMA: dict[str, dict[str, type | tuple[type, ...]]] = {
    "core": {"name": str, "description": str, "filesets": dict, "targets": dict, "parameters": dict},
    "fileset": {"files": list, "file_type": str, "depend": list},
    "file": {"is_include_file": bool, "include_path": str, "file_type": str},
    "target": {"filesets": list, "toplevel": (str, list), "default_tool": str, "parameters": list, "tools": dict},
    "parameter": {"datatype": str, "default": (bool, str, int, float), "description": str, "paramtype": str},
}
REQUIRED = {"core": {"name"}, "parameter": {"datatype", "paramtype"}}
VALUES = {"datatype": {"bool", "file", "int", "real", "str"}, "paramtype": {"cmdlinearg", "generic", "plusarg", "vlogdefine", "vlogparam"}}


def schema_errors(core: dict) -> list[str]:
    """What FuseSoC's schema would refuse."""
    found: list[str] = []

    def check(kind: str, place: str, entry: object) -> None:
        if not isinstance(entry, dict):
            found.append(f"{place} is no mapping")
            return
        found.extend(f"{place}: no key '{key}'" for key in sorted(REQUIRED.get(kind, set()) - entry.keys()))
        for key, value in entry.items():
            if key not in SCHEMA[kind]:
                found.append(f"{place}: unknown key '{key}'")
            elif not isinstance(value, SCHEMA[kind][key]):
                found.append(f"{place}: {key} is a {type(value).__name__}")
            elif isinstance(value, list) and key != "files" and not all(isinstance(one, str) for one in value):
                found.append(f"{place}: {key} has more than strings")
            elif value not in VALUES.get(key, {value} if isinstance(value, str) else [value]):
                found.append(f"{place}: {key} is '{value}'")

    check("core", "core", core)
    for kind in ("fileset", "target", "parameter"):
        for name, entry in core.get(f"{kind}s", {}).items():
            check(kind, f"{kind} {name}", entry)
    for name, fileset in core.get("filesets", {}).items():
        for entry in fileset.get("files", []) if isinstance(fileset, dict) else []:
            if isinstance(entry, dict) and len(entry) == 1:
                ((file, options),) = entry.items()
                check("file", file, options)
            elif not isinstance(entry, str):
                found.append(f"fileset {name}: a file is neither a name nor one name with its options")
    return found


OWN_SRAMS = ["hdl/technology/fpga/dtof_sram_1rw.sv", "hdl/technology/fpga/dtof_sram_1r1w.sv", "hdl/technology/fpga/dtof_clock_gate.sv"]  # for one's own


def resolved(names: list[str], flags: Set[str]) -> list[str]:
    """A list of CAPI2 under these flags."""
    found = []
    for name in names:
        condition = CONDITIONAL.fullmatch(name)
        if not condition:
            found.append(name)
        elif (condition.group(2) in flags) != bool(condition.group(1)):
            found += condition.group(3).split()
    return found


class Target:
    """A target of the core in a folder that has nothing but its files."""

    def __init__(self, name: str, folder: str, flags: Set[str] = frozenset()) -> None:
        self.target = CORE["targets"][name]
        self.folder = folder
        self.files: list[str] = []
        self.includes: set[str] = set()
        self.waivers: list[str] = []
        for fileset in resolved(self.target["filesets"], flags):
            for entry in CORE["filesets"][fileset]["files"]:
                file, options = next(iter(entry.items())) if isinstance(entry, dict) else (entry, {})
                self.add(file)
                if options.get("is_include_file"):
                    self.includes.add(options["include_path"])
                else:
                    (self.waivers if options.get("file_type") == "vlt" else self.files).append(file)

    def add(self, file: str):
        (Path(self.folder) / file).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / file, Path(self.folder) / file)

    def run(self, *command: str) -> subprocess.CompletedProcess:
        return subprocess.run(command, cwd=self.folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              check=False)  # fmt: skip

    def lint(self) -> subprocess.CompletedProcess:
        return self.run("verilator", "--lint-only", *self.target["tools"]["verilator"]["verilator_options"], *self.waivers,
                        *(f"-I{folder}" for folder in self.includes), *self.files, "--top-module", self.target["toplevel"],
                        "-GSRAM_NUM=2", "-GPIXELS_PER_SRAM=4", *(f"-G{entry}" for entry in self.target["parameters"] if "=" in entry))  # fmt: skip


class FuseSoc(unittest.TestCase):
    def test_the_core_keeps_capi2s_schema(self) -> None:
        self.assertEqual(schema_errors(CORE), [])

    def test_faults_against_the_schema_are_seen(self) -> None:
        for change, says in ((lambda core: core.pop("name"), "core: no key 'name'"),
                             (lambda core: core.update(licence="x"), "core: unknown key 'licence'"),
                             (lambda core: core["parameters"]["NP"].update(datatype="integer"), "parameter NP: datatype is 'integer'"),
                             (lambda core: core["parameters"]["NP"].pop("paramtype"), "parameter NP: no key 'paramtype'"),
                             (lambda core: core["targets"]["lint"].update(filesets="rtl"), "target lint: filesets is a str"),
                             (lambda core: core["targets"]["lint"]["parameters"].append(5), "target lint: parameters has more than strings"),
                             (lambda core: core["filesets"]["rtl"]["files"].append({"a": {}, "b": {}}),
                              "fileset rtl: a file is neither a name nor one name with its options"),
                             (lambda core: core["filesets"]["waivers"]["files"][0]["hdl/lint/verilator.vlt"].update(type="vlt"),
                              "hdl/lint/verilator.vlt: unknown key 'type'")):  # fmt: skip
            core = copy.deepcopy(CORE)
            change(core)
            self.assertEqual(schema_errors(core), [says])

    def test_what_a_target_names_is_there(self) -> None:
        self.assertEqual(set(CORE["targets"]), {"default", "lint", "sim", "synth"})
        for name, target in CORE["targets"].items():
            self.assertLessEqual({entry.split("=")[0] for entry in target.get("parameters", [])}, CORE["parameters"].keys(), name)
            for flags in (frozenset[str](), frozenset({file_lists.OWN_SRAMS})):
                self.assertLessEqual(set(resolved(target["filesets"], flags)), CORE["filesets"].keys(), name)
            self.assertEqual("tools" in target, name != "default")
            self.assertEqual(list(target.get("tools", {})), [target["default_tool"]] if "default_tool" in target else [])

    def test_lint_reads_in_verilator_with_its_parameters(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            target = Target("lint", folder)
            result = target.lint()
            self.assertEqual(result.returncode, 0, result.stdout)
            text = (HDL / "subsystem/dtof_subsystem.sv").read_text()
            declared = re.findall(r"^ +parameter int (\w+) ", text, re.MULTILINE)
            self.assertEqual(sorted(target.target["parameters"]), sorted(declared))

    def test_own_srams_take_the_place_of_the_stand_ins(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            target = Target("lint", folder, {file_lists.OWN_SRAMS})
            self.assertFalse([file for file in target.files if file.startswith("hdl/technology/")])
            result = target.lint()
            self.assertNotEqual(result.returncode, 0)
            self.assertIn("Cannot find file containing module: 'dtof_sram_1r1w'", result.stdout)
            for file in OWN_SRAMS:
                target.add(file)
                target.files.append(file)
            self.assertNotEqual(target.lint().returncode, 0)  # these have no clock gate
            target.target["parameters"].append("CLOCK_WAITS=0")
            self.assertEqual(target.lint().returncode, 0)

    def test_sim_simulates_a_frame(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            target = Target("sim", folder)
            top = target.target["toplevel"]
            result = target.run("iverilog", *target.target["tools"]["icarus"]["iverilog_options"], "-s", top, "-o", "sim.vvp",
                                f"-P{top}.ACQUISITIONS=200", f"-P{top}.READOUT=2",
                                *(f"-I{include}" for include in target.includes), *target.files)  # fmt: skip
            self.assertEqual(result.returncode, 0, result.stdout)
            result = target.run("vvp", "-n", "sim.vvp")
            self.assertEqual(result.stdout.splitlines()[-1], "PASS")
            self.assertIn("200 acquisitions", result.stdout)

    def test_synth_reads_in_yosys(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            target = Target("synth", folder)
            self.assertIn("hdl/technology/fpga/dtof_sram_1rw.sv", target.files)
            result = target.run("yosys", "-q", "-p", f"read_verilog -sv {' '.join(f'-I{name}' for name in target.includes)} "
                                f"{' '.join(target.files)}; chparam -set SRAM_NUM 2 -set PIXELS_PER_SRAM 4 "
                                f"{' '.join('-set ' + entry.replace('=', ' ') for entry in target.target['parameters'] if '=' in entry)} dtof_subsystem; "
                                f"hierarchy -check -top {target.target['toplevel']}; proc; check -assert")  # fmt: skip
            self.assertEqual(result.returncode, 0, result.stdout)


class Bender(unittest.TestCase):
    def test_its_files_are_those_of_the_list(self) -> None:
        package, technology, rest = file_lists.split((HDL / "dtof.f").read_text(encoding="utf-8"))
        self.assertEqual([file for source in BENDER["sources"] for file in source["files"]], [f"hdl/{file}" for file in package + technology + rest])
        self.assertEqual([source["files"] for source in BENDER["sources"] if "target" in source],
                         [[f"hdl/{file}" for file in technology]])
        self.assertEqual(BENDER["export_include_dirs"], ["hdl/common"])
        for source in BENDER["sources"]:
            self.assertLessEqual(source.keys(), {"include_dirs", "target", "files"})


class Lists(unittest.TestCase):
    def test_the_list_without_srams_reads_as_its_head_says(self) -> None:
        text = (HDL / "dtof_no_srams.f").read_text(encoding="utf-8")
        found = re.search(r"^// +(verilator .*)$", text, re.MULTILINE)
        assert found is not None
        command = found[1]
        command = command.replace("my_srams/", "technology/fpga/") + " -GSRAM_NUM=2 -GPIXELS_PER_SRAM=4 -GCLOCK_WAITS=0"
        for name, there in (("dtof_sram_1rw.sv", True), ("sram_9.sv", False)):
            result = subprocess.run(command.replace("dtof_sram_1rw.sv", name).split(), cwd=HDL, text=True, stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, check=False)  # fmt: skip
            self.assertEqual(result.returncode == 0, there, result.stdout)

    def test_a_list_without_technology_is_refused(self) -> None:
        with self.assertRaisesRegex(FlowError, "no technology"):
            file_lists.split("common/dtof_pkg.sv\ntop/dtof_array.sv\n")


class Vivado(unittest.TestCase):
    """Yosys has a Tcl interpreter; Vivado's commands write down how they were called."""

    STUBS = """
proc read_verilog {option files} { foreach file $files { puts "$option $file" } }
proc current_fileset {} { return sources_1 }
proc set_property {name value object} { puts "$name $value $object" }
"""

    def sourced(self, call: str) -> subprocess.CompletedProcess:
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder) / "run.tcl"
            script.write_text(f"{self.STUBS}\nsource {ROOT}/synth/vivado/dtof.tcl\n{call}\n", encoding="utf-8")
            return subprocess.run(["yosys", "-Q", "-T", "-c", str(script)], text=True, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, check=False)  # fmt: skip

    def test_it_reads_all_rtl_with_memories_of_an_fpga(self) -> None:
        result = self.sourced("dtof_read_rtl")
        self.assertEqual(result.returncode, 0, result.stdout)
        package, technology, rest = file_lists.split((HDL / "dtof.f").read_text(encoding="utf-8"))
        memories = [file.replace("behavioural", "fpga") for file in reversed(technology)]
        expected = [f"-sv {HDL}/{file}" for file in [*package, *rest, *memories]]
        lines = result.stdout.splitlines()
        self.assertEqual([line for line in lines if line.startswith("-sv")], expected)
        (includes,) = re.findall(r"^include_dirs (\S+) sources_1$", result.stdout, re.MULTILINE)
        named = re.findall(r"^\+incdir\+(\S+)$", (HDL / "dtof.f").read_text(encoding="utf-8"), re.MULTILINE)
        self.assertEqual([includes], [f"{HDL}/{name}" for name in named])
        self.assertTrue((Path(includes) / "dtof_macros.svh").is_file())

    def test_a_folder_without_memories_is_refused(self) -> None:
        result = self.sourced(f"dtof_read_rtl {ROOT}/docs")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("dtof_sram_1rw.sv is not there", result.stdout)


if __name__ == "__main__":
    unittest.main()
