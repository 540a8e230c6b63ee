# SPDX-License-Identifier: Apache-2.0
"""The module for LiteX (examples/litex). LiteX and migen are not in Debian: small stand-ins of what the module uses of them, written from
their published sources, collect the instances and write them as Verilog, which Verilator reads with the RTL under -Wall. Where migen
and LiteX are installed, their own Verilog is read, too."""

import importlib.util
import re
import subprocess
import sys
import tempfile
import types
import unittest
from collections.abc import Iterator, Mapping
from pathlib import Path
from unittest import mock

ROOT = Path(__file__).resolve().parents[2]
HDL = ROOT / "hdl"
INSTALLED = all(importlib.util.find_spec(name) for name in ("migen", "litex"))


class Signal:
    count = 0

    def __init__(self, bits: int = 1):
        Signal.count += 1
        self.bits, self.name = bits, f"signal_{Signal.count}"

    def __getitem__(self, part: slice) -> "Text":
        assert part.start is None and part.step is None and 0 < part.stop <= self.bits
        return Text(f"{self.name}[{part.stop - 1}:0]", [self])


class Text:
    """An expression as Verilog, and the signals in it."""

    def __init__(self, text: str, signals: list[Signal]):
        self.text, self.signals = text, signals


class Constant(Text):
    def __init__(self, value: int, bits: int):
        super().__init__(f"{bits}'d{value}", [])
        self.value = value


class ClockSignal(Text):
    def __init__(self, domain: str):
        super().__init__(f"{domain}_clk", [])


class ResetSignal(Text):
    def __init__(self, domain: str):
        super().__init__(f"{domain}_rst", [])

    def __invert__(self) -> Text:
        return Text(f"~{self.text}", [])


class Instance:
    def __init__(self, of: str, **items: int | Signal | Text):
        self.of, self.items = of, items

    def verilog(self) -> str:
        kinds: dict[str, list[str]] = {"p": [], "i": [], "o": []}
        for key, value in items_of(self):
            kind, name = key.split("_", maxsplit=1)
            if isinstance(value, int):
                value = Constant(value, max(value.bit_length(), 1))
            kinds[kind].append(f".{name}({value.name if isinstance(value, Signal) else value.text})")
        pins = ",\n  ".join(kinds["i"] + kinds["o"])
        return f"{self.of} #(\n  {', '.join(kinds['p'])}\n) u_{self.of} (\n  {pins}\n);\n"


def items_of(instance: Instance) -> list[tuple[str, int | Signal | Text]]:
    return sorted(instance.items.items())


class Collector:
    """What has been added with +=, in this order."""

    def __init__(self) -> None:
        self.instances: list[Instance] = []

    def __iadd__(self, instance: Instance) -> "Collector":
        self.instances.append(instance)
        return self

    def __iter__(self) -> Iterator[Instance]:
        return iter(self.instances)

    def __getitem__(self, index: int) -> Instance:
        return self.instances[index]


class LiteXModule:
    _instances: Collector

    @property
    def specials(self) -> Collector:
        return self.__dict__.setdefault("_instances", Collector())

    @specials.setter
    def specials(self, value: Collector) -> None:
        assert value is self._instances


class Endpoint:
    def __init__(self, layout: list[tuple[str, int]]):
        self.valid, self.ready, self.first, self.last = Signal(), Signal(), Signal(), Signal()
        for name, bits in layout:
            setattr(self, name, Signal(bits))


class AXILiteInterface:
    def __init__(self, data_width: int = 32, address_width: int = 32, clock_domain: str = "sys"):
        address, response = [("addr", address_width), ("prot", 3)], [("resp", 2)]
        self.aw, self.ar = Endpoint(address), Endpoint(address)
        self.w, self.b, self.r = Endpoint([("data", data_width), ("strb", data_width // 8)]), Endpoint(response), Endpoint([*response, ("data", data_width)])


class Platform:
    def __init__(self):
        self.files: list[str] = []
        self.includes: list[str] = []

    def add_source(self, name: str) -> None:
        self.files.append(name)

    def add_verilog_include_path(self, name: str) -> None:
        self.includes.append(name)


def stand_ins() -> dict[str, types.ModuleType]:
    contents = {"migen": (ClockSignal, Constant, Instance, ResetSignal, Signal), "litex": (), "litex.gen": (LiteXModule,), "litex.soc": (),
                "litex.soc.interconnect": (), "litex.soc.interconnect.stream": (Endpoint,), "litex.soc.interconnect.axi": (AXILiteInterface,)}
    modules = {name: types.ModuleType(name) for name in contents}
    for name, classes in contents.items():
        vars(modules[name]).update({each.__name__: each for each in classes})
    vars(modules["litex.soc.interconnect"])["stream"] = modules["litex.soc.interconnect.stream"]
    return modules


def load() -> types.ModuleType:
    spec = importlib.util.spec_from_file_location("dtof_litex", ROOT / "examples/litex/dtof_litex.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def verilog(dtof) -> str:
    """The module with its interfaces as ports."""
    into = [dtof.lines.valid, dtof.lines.data, dtof.lines.last, dtof.results.ready, dtof.bus.b.ready, dtof.bus.r.ready]
    into += [signal for channel in (dtof.bus.aw, dtof.bus.ar) for signal in (channel.valid, channel.addr)]
    into += [dtof.bus.w.valid, dtof.bus.w.data, dtof.bus.w.strb]
    out = [dtof.lines.ready, dtof.results.valid, dtof.results.data, dtof.results.first, dtof.results.last, dtof.shot, dtof.ev.irq]
    out += [dtof.bus.aw.ready, dtof.bus.w.ready, dtof.bus.ar.ready, dtof.bus.b.valid, dtof.bus.b.resp, dtof.bus.r.valid, dtof.bus.r.resp,
            dtof.bus.r.data]
    used = {signal.name: signal for instance in dtof.specials for _, value in items_of(instance)
            for signal in ([value] if isinstance(value, Signal) else getattr(value, "signals", []))}
    ports = ["input wire sys_clk", "input wire sys_rst"]
    ports += [f"{way} wire [{signal.bits - 1}:0] {signal.name}" for way, signals in (("input", into), ("output", out)) for signal in signals]
    inside = [signal for name, signal in used.items() if name not in {port.name for port in into + out}]
    wires = "".join(f"wire [{signal.bits - 1}:0] {signal.name};\n" for signal in inside)
    head = ",\n  ".join(ports)
    return f"module top (\n  {head}\n);\n{wires}{''.join(each.verilog() for each in dtof.specials)}endmodule\n"


def lint(text: str, platform: Platform) -> str:
    """What Verilator says about it; nothing where all ports are connected in their widths. Address bits above the registers' are not used."""
    with tempfile.TemporaryDirectory() as folder:
        top = Path(folder) / "top.v"
        top.write_text(text, encoding="utf-8")
        waiver = Path(folder) / "top.vlt"
        waiver.write_text('`verilator_config\nlint_off -rule UNUSEDSIGNAL -file "*top.v"\nlint_off -rule DECLFILENAME -file "*top.v"\n'
                          'lint_off -rule TIMESCALEMOD -file "*top.v"\n', encoding="utf-8")
        done = subprocess.run(["verilator", "--lint-only", "-Wall", "-f", "dtof_lint.f", waiver, *(f"+incdir+{name}" for name in platform.includes),
                               *platform.files, top, "--top-module", "top"], cwd=HDL, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
        return done.stdout if done.returncode != 0 else ""


class StandIns(unittest.TestCase):
    def setUp(self) -> None:
        patch = mock.patch.dict(sys.modules, stand_ins())
        patch.start()
        self.addCleanup(patch.stop)
        self.module = load()

    def make(self, *arguments, **keywords):
        platform = Platform()
        return self.module.DtofSubsystem(platform, *arguments, **keywords), platform

    def test_ports_and_parameters_are_the_rtls(self) -> None:
        cases: list[tuple[str, dict[str, str | int]]] = [
            ("hispointer", {"sram_num": 3, "pixels_per_sram": 5}), ("ezpointer", {"np": 9, "technology": "behavioural"}),
            ("poolpointer-lean", {"sram_num": 4, "pixels_per_sram": 16, "second_target": 1})]
        for readout, settings in cases:
            with self.subTest(readout=readout):
                self.assertEqual(lint(*self.made(readout, settings)), "")

    def made(self, readout: str, settings: Mapping[str, str | int]) -> tuple[str, Platform]:
        dtof, platform = self.make(readout=readout, **settings)
        return verilog(dtof), platform

    def test_a_port_that_is_missing_unknown_or_of_another_width_is_seen(self) -> None:
        text, platform = self.made("hispointer", {"sram_num": 3})
        for before, after, says in ((".irq_o(", ".irq(", "PINNOTFOUND"), (".NP(32'd10)", ".NP(32'd12)", "WIDTH"),
                                    (".SRAM_NUM(", ".SRAMS(", "SRAMS"), (".pstrb_i(", ".pwrite_i(", "PINMISSING|DUPLICATE|Duplicate")):
            self.assertIn(before, text)
            self.assertRegex(lint(text.replace(before, after, 1), platform), says)

    def test_directions_are_the_rtls(self) -> None:
        """Verilog's connections have none, but migen takes what drives a signal from them."""
        dtof, _ = self.make()
        for instance in dtof.specials:
            (source,) = HDL.glob(f"*/{instance.of}.sv")
            found = re.findall(r"^ +(input|output) +logic.*? (\w+)(?=,| *//|$)", source.read_text(encoding="utf-8"), re.MULTILINE)
            self.assertEqual({f"{way[0]}_{name}" for way, name in found}, {key for key in instance.items if not key.startswith("p_")})

    def test_all_files_are_named_with_the_technology(self) -> None:
        listed = [line for line in (HDL / "dtof.f").read_text(encoding="utf-8").splitlines() if line.endswith(".sv") and not line.startswith("//")]
        for technology in ("fpga", "behavioural"):
            _, platform = self.make(technology=technology)
            self.assertEqual([str(HDL / line.replace("/behavioural/", f"/{technology}/")) for line in listed], platform.files)
        with tempfile.TemporaryDirectory() as folder:
            _, platform = self.make(technology=folder)
            self.assertIn(f"{folder}/dtof_clock_gate.sv", platform.files)

    def test_an_fpga_has_no_clock_gate(self) -> None:
        cases: list[tuple[dict[str, str | int], int | None]] = [({}, 0), ({"technology": "behavioural"}, None), ({"clock_waits": 1}, 1)]
        for settings, expected in cases:
            dtof, _ = self.make(**settings)
            chosen = dtof.specials[1].items.get("p_CLOCK_WAITS")
            self.assertEqual(chosen and chosen.value, expected)

    def test_names_that_are_not_there_are_refused(self) -> None:
        cases: list[tuple[dict[str, str | int], str]] = [({"readout": "hisponter"}, "no read-out is called"),
                                                         ({"columns": 4}, "no parameter COLUMNS")]
        for arguments, says in cases:
            with self.assertRaisesRegex(ValueError, says):
                self.make(**arguments)


@unittest.skipUnless(INSTALLED, "migen and LiteX are not installed")
class WithLiteX(unittest.TestCase):
    def test_its_verilog_is_read_with_the_rtl(self) -> None:
        from migen.fhdl.verilog import convert

        platform = Platform()
        dtof = load().DtofSubsystem(platform, sram_num=3, pixels_per_sram=5)
        ios = {dtof.shot, dtof.ev.irq, *dtof.lines.flatten(), *dtof.results.flatten()}
        ios |= {signal for name in ("aw", "w", "b", "ar", "r") for signal in getattr(dtof.bus, name).flatten()}
        text = convert(dtof, ios=ios, name="top").main_source
        self.assertIn("dtof_subsystem", text)
        self.assertEqual(lint(text, platform), "")


if __name__ == "__main__":
    unittest.main()
