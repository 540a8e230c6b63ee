# SPDX-License-Identifier: Apache-2.0
"""dtof_subsystem as a module of LiteX: registers behind AXI4-Lite, lines in, results out, an interrupt.

    self.submodules.dtof = DtofSubsystem(platform, readout="hispointer", sram_num=8, pixels_per_sram=16)
    self.bus.add_slave("dtof", self.dtof.bus, SoCRegion(origin=0x90000000, size=0x1000, cached=False))
    self.irq.add("dtof")
    self.comb += sensor.lines.connect(self.dtof.lines)    # and self.dtof.results to a DMA
"""

import re
import tomllib
from pathlib import Path
from types import SimpleNamespace

from litex.gen import LiteXModule
from litex.soc.interconnect import stream
from litex.soc.interconnect.axi import AXILiteInterface
from migen import ClockSignal, Constant, Instance, ResetSignal, Signal

ROOT = Path(__file__).resolve().parents[2]
HDL = ROOT / "hdl"
ADDRESS_BITS = 12
RESULT_BITS = 64
INT_BITS = 32  # the RTL's parameters are of type int
PARAMETER = re.compile(r"^ *parameter int (\w+) =", re.MULTILINE)


def sources(technology: str) -> list[Path]:
    """hdl/dtof.f; `technology`: the folder of SRAMs and clock gate, "fpga", "behavioural", or a path to your own."""
    lines = [line for line in (HDL / "dtof.f").read_text(encoding="utf-8").splitlines() if line.endswith(".sv") and not line.startswith("//")]
    folder = HDL / "technology" / technology  # a path from the root on stays what it is
    return [folder / Path(line).name if line.startswith("technology/") else HDL / line for line in lines]


def parameters(readout: str, given: dict[str, int]) -> dict[str, int]:
    """The parameters of dtof_subsystem for a read-out of readouts.toml, with those that are given by their names in lower case."""
    table = tomllib.loads((ROOT / "readouts.toml").read_text(encoding="utf-8"))
    if readout not in table["readout"]:
        raise ValueError(f"no read-out is called '{readout}': {', '.join(table['readout'])}")
    entry = table["readout"][readout]
    top = table["top"][entry.get("top", "dtof_array")]
    number = entry.get("number", top.get("readout"))
    if number is None:
        raise ValueError(f"{readout} has no RTL")
    own = {name: value for name, value in entry.get("defaults", {}).items()
           if isinstance(value, int) and name in [*top["parameters"], *top.get("schedule", [])]}
    legal = set(PARAMETER.findall((HDL / "subsystem/dtof_subsystem.sv").read_text(encoding="utf-8"))) - {"READOUT"}
    chosen = {name.upper(): value for name, value in given.items()}
    if unknown := sorted(chosen.keys() - legal):
        raise ValueError(f"dtof_subsystem has no parameter {', '.join(unknown)}; it has {', '.join(sorted(legal))}")
    return {"READOUT": number} | own | chosen


class DtofSubsystem(LiteXModule):
    """`readout` and further parameters of docs/user/configuration.md, in lower case: np, sram_num (columns), pixels_per_sram (rows), ...

    bus      AXILiteInterface: the registers, 4 KiB; the driver is driver/dtof.h
    ev.irq   the interrupt, a level; IRQ_ENABLE chooses its causes
    lines    stream.Endpoint, sink: data is a timestamp of every column, column 0 lowest; last ends an acquisition
    results  stream.Endpoint, source: data is a result word of 64 bits; first and last are a frame's
    shot     Signal: fires the laser and starts the TDCs; may stay open
    """

    def __init__(self, platform, readout: str = "hispointer", np: int = 10, sram_num: int = 8, technology: str = "fpga",
                 clock_domain: str = "sys", **others: int):
        # An FPGA's clocks do not rest: hdl/technology/fpga has no clock gate.
        given = ({"clock_waits": 0} if technology == "fpga" else {}) | others | {"np": np, "sram_num": sram_num}
        chosen = parameters(readout, given)
        platform.add_verilog_include_path(str(HDL / "common"))
        for source in sources(technology):
            platform.add_source(str(source))

        self.bus = bus = AXILiteInterface(data_width=32, address_width=32, clock_domain=clock_domain)
        self.lines = lines = stream.Endpoint([("data", 8 * ((sram_num * np + 7) // 8))])
        self.results = results = stream.Endpoint([("data", RESULT_BITS)])
        self.shot = Signal()
        # SoC.irq looks for ev.irq. There is no EventManager: the subsystem has the registers of one, IRQ_STATUS and IRQ_ENABLE.
        self.ev = SimpleNamespace(irq=Signal())

        common = {"i_clk_i": ClockSignal(clock_domain), "i_rst_ni": ~ResetSignal(clock_domain)}
        apb = {"psel": Signal(), "penable": Signal(), "pwrite": Signal(), "paddr": Signal(ADDRESS_BITS), "pwdata": Signal(32),
               "pstrb": Signal(4)}
        answer = {"pready": Signal(), "prdata": Signal(32), "pslverr": Signal()}
        channels: dict[str, Signal] = {}
        for name, to_subsystem in (("aw", True), ("w", True), ("b", False), ("ar", True), ("r", False)):
            channel = getattr(bus, name)
            channels |= {f"{'i' if to_subsystem else 'o'}_s_axi_{name}valid_{'i' if to_subsystem else 'o'}": channel.valid,
                         f"{'o' if to_subsystem else 'i'}_s_axi_{name}ready_{'o' if to_subsystem else 'i'}": channel.ready}
        self.specials += Instance(
            "dtof_axi_lite_to_apb", p_ADDR_WIDTH=Constant(ADDRESS_BITS, INT_BITS), **common, **channels,
            i_s_axi_awaddr_i=bus.aw.addr[:ADDRESS_BITS], i_s_axi_wdata_i=bus.w.data, i_s_axi_wstrb_i=bus.w.strb,
            i_s_axi_araddr_i=bus.ar.addr[:ADDRESS_BITS], o_s_axi_bresp_o=bus.b.resp, o_s_axi_rresp_o=bus.r.resp, o_s_axi_rdata_o=bus.r.data,
            **{f"o_{name}_o": signal for name, signal in apb.items()}, **{f"i_{name}_i": signal for name, signal in answer.items()})
        self.specials += Instance(
            "dtof_subsystem", **{f"p_{name}": Constant(value, INT_BITS) for name, value in chosen.items()}, **common,
            i_scan_mode_i=0, i_sram_cfg_i=0, o_sram_cfg_o=Signal(),
            **{f"i_{name}_i": signal for name, signal in apb.items()}, **{f"o_{name}_o": signal for name, signal in answer.items()},
            o_irq_o=self.ev.irq, o_shot_o=self.shot,
            i_s_axis_tvalid_i=lines.valid, o_s_axis_tready_o=lines.ready, i_s_axis_tdata_i=lines.data, i_s_axis_tlast_i=lines.last,
            o_m_axis_tvalid_o=results.valid, i_m_axis_tready_i=results.ready, o_m_axis_tdata_o=results.data,
            o_m_axis_tuser_o=results.first, o_m_axis_tlast_o=results.last)
