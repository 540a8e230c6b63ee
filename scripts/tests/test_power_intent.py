# SPDX-License-Identifier: Apache-2.0
"""The power intent of constraints/power_intent fits the RTL of every read-out, and planted faults are found."""

import re
import subprocess
import tempfile
import unittest
from pathlib import Path

import power_intent
import upf
from upf import Design

ROOT = Path(__file__).resolve().parents[2]
INTENT = ROOT / "constraints" / "power_intent"
SMALL = {"SRAM_NUM": 3, "PIXELS_PER_SRAM": 4}
POOL_SMALL = {"SRAM_NUM": 3, "PIXELS_PER_SRAM": 8, "ENGINE_COLUMNS": 2, "PRIOR": 1, "PARITY": 1}
MEMORIES = {"RASTER_ORDER": 1, "BUFFER_LINES": 9, "PARITY": 1, "SECOND_TARGET": 1}  # the subsystem's own, which are always on
PRIOR, NO_PRIOR = {"dtof_prior": "1"}, {"dtof_prior": "0"}
READOUTS = {name: int(number) for name, number in re.findall(
    r"localparam int READOUT_(\w+) = (\d+);", (ROOT / "hdl/common/dtof_readouts.svh").read_text(encoding="utf-8"))}  # fmt: skip

FAULTS = {  # file, text, replacement, with a prior, what is said
    "an output without isolation": ("array", "-applies_to outputs", "-applies_to inputs", True, "port u_gated_array.g_pool.u_array.busy_o: 0 isolations"),
    "a memory's write enable without isolation": (
        "array", "{read_en_i read_addr_i write_en_i write_addr_i write_parts_i write_data_i}",
        "{read_en_i read_addr_i write_addr_i write_parts_i write_data_i}", True,
        "u_sram.write_en_i: 0 isolations"),
    "a wrong clamp": ("array", "-applies_to outputs -clamp_value 0", "-applies_to outputs -clamp_value 1", True, "busy_o: clamp 1, but 0 between frames"),
    "the side band clamped like the others": ("array", "{sram_cfg_o} -clamp_value 1", "{sram_cfg_o} -clamp_value 0", True, "clamp 0, but 1 between"),
    "a write enable that is clamped high": ("array", "$dtof_memory_inputs -clamp_value 0", "$dtof_memory_inputs -clamp_value 1", True,
                                            "write_en_i: clamp 1, but 0"),
    "two strategies for a port": ("array", "-elements {sram_cfg_o} -clamp_value 1", "-elements {sram_cfg_o sram_cfg_o} -clamp_value 1", True,
                                  "strategies iso_side_band and iso_side_band"),
    "an isolation of a port that is renamed": ("array", "{sram_cfg_o}", "{sram_config_o}", True, "no port u_gated_array.g_pool.u_array.sram_config_o"),
    "an isolation that loses its supply": (
        "array", "-clamp_value 0 \\\n    -isolation_supply_set SS_ALWAYS", "-clamp_value 0 \\\n    -isolation_supply_set SS_ARRAY", True,
        "busy_o: the supply of its isolation is off"),
    "an isolation of the memories that loses its supply": ("array", "-isolation_supply_set SS_MEMORY", "-isolation_supply_set SS_ARRAY", True,
                                                           "write_en_i: the supply of its isolation is off"),
    "an isolation signal of nobody": ("array", "isolation_signal isolate_i -isolation_sense high -location self\nset", "isolation_signal isolated_i "
                                      "-isolation_sense high -location self\nset", True, "logic_port u_gated_array.g_pool.u_array.isolated_i is not declared"),
    "an undeclared supply": ("array", "create_supply_net VDD_ARRAY\n", "", False, "supply_net u_gated_array.g_array.u_array.VDD_ARRAY is not declared"),
    "a supply without a source": ("array", "connect_supply_net VDD -ports {VDD}\n", "", False, "supply net u_gated_array.g_array.u_array.VDD has 0 sources"),
    "a supply with two sources": ("array", "vout VDD_MEMORY", "vout VDD_ARRAY", True, "supply net u_gated_array.g_pool.u_array.VDD_ARRAY has 2 sources"),
    "a supply of the array that the subsystem does not connect": ("subsystem", "connect_supply_net VDD -ports [list $dtof_array/VDD]\n", "", False,
                                                                  "supply port u_gated_array.g_array.u_array.VDD is not connected"),
    "a domain without a supply": ("array", "-elements {.} -supply {primary SS_ARRAY}", "-elements {.}", False, "PD_ARRAY has no primary supply"),
    "a control that the subsystem does not connect": ("subsystem", "{array_on_i isolate_i}", "{array_on_i}", False,
                                                      "logic port u_gated_array.g_array.u_array.isolate_i is not connected"),
    "a switch that is open when its control is high": ("array", "{closed vin {control}} -off_state {open {!control}}\n\n# The",
                                                       "{closed vin {!control}} -off_state {open {control}}\n\n# The", False, "-on_state does not follow"),
    "memories that are renamed": ("array", "{u_sram u_parities}", "{u_ram}", True, "PD_MEMORY has no instance"),
    "an instance that is not there": ("array", "PD_ARRAY -elements {.}", "PD_ARRAY -elements {. u_gone}", False, "no instance u_gated_array.g_array.u_array.u_gone"),
    "an array that is not there": ("subsystem", "*u_array", "*u_matrix", False, "no instance"),
    "an instance in two domains": ("subsystem", "PD_SUBSYSTEM -elements {.}", "PD_SUBSYSTEM -elements {. u_gated_array.g_array.u_array}", False,
                                  "u_array is in PD_SUBSYSTEM and in"),
    "a memory of the prior in two domains": ("array", "-elements {.} -supply {primary SS_ARRAY}",
                                             "-elements {. {g_quad[0].u_quad/u_sram}} -supply {primary SS_ARRAY}", True,
                                             "u_sram is in u_gated_array.g_pool.u_array.PD_ARRAY and in"),
    "a subsystem without a domain": ("subsystem", "-elements {.} -supply {primary SS_ALWAYS}", "-elements {u_registers} -supply {primary SS_ALWAYS}", False,
                                     "instance u_frame_control is in no domain"),
    "scratch memories are kept, those of the prior are not": ("array", "{u_sram u_parities}", "{u_scratch_sram}", True, "u_quad.u_sram is not kept"),
    "the parities of the prior are not kept": ("array", "{u_sram u_parities}", "{u_sram}", True, "u_parity_store.u_parities is not kept"),
    "more memories than those of the prior are kept": ("array", "{u_sram u_parities}", "{u_*sram u_parities}", True, "u_scratch_sram.u_words is kept"),
    "the prior's state has the memories off": ("array", "SS_ARRAY == off && SS_MEMORY == on", "SS_ARRAY == off && SS_MEMORY == off", True,
                                               "u_sram is not kept"),
    "a state of an unknown supply": ("array", "frame -logic_expr {SS_ARRAY == on &&", "frame -logic_expr {SS_LOGIC == on &&", True,
                                     "supply_set u_gated_array.g_pool.u_array.SS_LOGIC is not declared"),
    "a state of a supply that has no such state": ("array", "frame -logic_expr {SS_ARRAY == on &&", "frame -logic_expr {SS_ARRAY == full &&", True,
                                                   "supply SS_ARRAY has no state full"),
    "a switched supply without an off state": ("array", " \\\n    -state {off -supply_expr {power == OFF} -simstate CORRUPT}\n\nif", "\n\nif", False,
                                               "SS_ARRAY: states off and on expected"),
    "a flip-flop that is renamed": ("array", "}ended_q", "}over_q", True, "no register u_gated_array.g_pool.u_array.u_control.g_prior.over_q"),
    "the flip-flop of the prior is not kept": ("array", "set_retention ret_prior", "set ignored [list ret_prior", True, ""),
    "a retention that loses its supply": ("array", "-retention_supply_set SS_ALWAYS", "-retention_supply_set SS_ARRAY", True, "its supply may be off"),
    "a retention by a level": ("array", "{restore_i posedge}", "{restore_i high}", True, "-restore_signal needs an edge"),
    "an unknown option": ("array", "-location self\nset_isolation iso_side_band", "-place self\nset_isolation iso_side_band", False, "unknown option -place"),
    "an unknown command": ("array", "set_isolation iso_side_band", "set_insulation iso_side_band", False, "invalid command name"),
}  # fmt: skip


def design(top: str, readout: int | None, parameters: dict[str, int]) -> Design:
    return upf.elaborate(top, parameters if readout is None else {"READOUT": readout} | parameters)


class PowerIntent(unittest.TestCase):
    array: Design
    pool: Design

    @classmethod
    def setUpClass(cls) -> None:
        cls.array = design("dtof_subsystem", READOUTS["HISPOINTER"], SMALL)
        cls.pool = design("dtof_subsystem", upf.POOL, POOL_SMALL | MEMORIES)

    def test_it_fits_both_subsystems(self) -> None:
        for separator in (".", "/"):
            for of, settings in ((self.array, NO_PRIOR), (self.pool, NO_PRIOR), (self.pool, PRIOR)):
                with self.subTest(separator=separator, **settings):
                    self.assertEqual(power_intent.problems(INTENT / "dtof_subsystem.upf", of, settings, separator), [])

    def test_it_fits_the_bare_array_of_every_readout(self) -> None:
        arrays = [("dtof_array", number, SMALL) for number in READOUTS.values() if number != upf.POOL]
        self.assertGreater(len(arrays), 8)
        for top, number, parameters in [*arrays, ("dtof_pool_pointer_array", None, POOL_SMALL)]:
            with self.subTest(top=top, number=number):
                settings = PRIOR if "PRIOR" in parameters else NO_PRIOR
                self.assertEqual(power_intent.problems(INTENT / "dtof_array.upf", design(top, number, parameters), settings), [])

    def test_the_elaborated_names_are_those_of_the_rtl(self) -> None:
        """What the checks compare with: names, directions, wiring, registers, values between frames."""
        array = self.pool.scopes["u_gated_array.g_pool.u_array"]
        self.assertEqual((array.module, array.ports["clk_i"], array.ports["busy_o"]), ("dtof_pool_pointer_array", "INPUT", "OUTPUT"))
        memory = self.pool.scopes["u_gated_array.g_pool.u_array.g_quad[1].u_quad.u_sram"]
        self.assertEqual(memory.sources["clk_i"], array.sources["clk_i"])
        self.assertNotEqual(memory.sources["write_en_i"], array.sources["clk_i"])
        self.assertIn("memory", self.pool.scopes["u_gated_array.g_pool.u_array.g_quad[1].u_quad.u_sram.g_one_port.u_macro"].registers)
        self.assertEqual(self.pool.idle["u_gated_array.g_pool.u_array.busy_o"], "0")
        self.assertIn("x", self.pool.idle["u_gated_array.g_pool.u_array.result_tdata_o"])

    def test_a_prior_needs_its_parameter(self) -> None:
        found = power_intent.problems(INTENT / "dtof_subsystem.upf", self.array, PRIOR)
        self.assertIn("retention ret_prior: no register u_gated_array.g_array.u_array.u_control.g_prior.ended_q in u_gated_array.g_array.u_array.PD_ARRAY", found)

    def test_planted_faults_are_found(self) -> None:
        for fault, (file, old, new, prior, said) in FAULTS.items():
            with self.subTest(fault=fault), tempfile.TemporaryDirectory() as folder:
                for name in ("array", "subsystem"):
                    text = (INTENT / f"dtof_{name}.upf").read_text(encoding="utf-8")
                    if name == file:
                        self.assertEqual(text.count(old), 1)
                        text = text.replace(old, new)
                        if new.endswith("[list ret_prior"):
                            text = text.replace("{restore_i posedge}", "{restore_i posedge}]")
                    (Path(folder) / f"dtof_{name}.upf").write_text(text, encoding="utf-8")
                found = power_intent.problems(Path(folder) / "dtof_subsystem.upf", self.pool if prior else self.array, PRIOR if prior else NO_PRIOR)
                self.assertTrue(found)
                self.assertIn(said, "\n".join(found))

    def test_faults_of_the_rtl_are_found(self) -> None:
        """A memory's clock that comes from inside of the array; an output that is high between frames."""
        for path, name, idle, said in (("u_gated_array.g_pool.u_array.g_quad[0].u_quad.u_sram", "clk_i", "", "clk_i: 0 isolations"),
                                       ("u_gated_array.g_pool.u_array", "tdc_ready_o", "1", "tdc_ready_o: clamp 0, but 1 between frames")):
            scopes = self.pool.scopes
            if not idle:
                changed = upf.Scope(scopes[path].module, scopes[path].ports, scopes[path].sources | {name: "a gate"}, scopes[path].registers)
                scopes = scopes | {path: changed}
            changes = {f"{path}.{name}": idle} if idle else {}
            changed_design = Design(self.pool.top, scopes, self.pool.idle | changes)
            with self.subTest(name=name):
                self.assertIn(said, "\n".join(power_intent.problems(INTENT / "dtof_subsystem.upf", changed_design, PRIOR)))



class CommandLine(unittest.TestCase):
    def test_bad_arguments_get_one_line(self) -> None:
        file = "constraints/power_intent/dtof_array.upf"
        for arguments, says in ((["gone.upf", "dtof_array"], "gone.upf is no file"), ([file, "dtof_array", "NB"], "'NB' is not PARAMETER=VALUE"),
                                ([file, "gone"], "gone with these parameters: ")):
            with self.subTest(arguments=arguments):
                done = subprocess.run([ROOT / "scripts/power_intent.py", *arguments], cwd=ROOT, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 2)
                self.assertEqual(done.stderr.count("\n"), 1, done.stderr)
                self.assertIn(says, done.stderr)


if __name__ == "__main__":
    unittest.main()
