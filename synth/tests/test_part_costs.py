# SPDX-License-Identifier: Apache-2.0
"""Parts are found under the names that the waveform has, and by the names of their instances."""

import tempfile
import unittest
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

from dtof_synth import activity, configuration, liberty, library, mapping, part_costs, sram_model, standard_cells
from dtof_synth.activity import STREAMING, Activity, Energy, Scope
from dtof_synth.sram_model import Size
from dtof_synth.technology import Technology

from .partial import part_of
from .small_results import ROOT


def module(**cells: str) -> dict:
    return {"attributes": {}, "ports": {}, "netnames": {},
            "cells": {name: {"type": kind, "connections": {}, "port_directions": {}} for name, kind in cells.items()}}


def design() -> dict:
    """An array of a pair, in which an SRAM stands before a column of two parts, and an engine with a part of the same kind."""
    return {"modules": {
        "array": module(u_gate="INV", **{"g[0].u_quad": "dtof_pool_quad", "g[0].u_engine": "dtof_pool_engine"}) | {"attributes": {"top": "1"}},
        "dtof_pool_quad": module(u_sram="sram_1rw_4x4", u_rest="INV", **{"g_column[0].u_column": "column"}),
        "column": module(u_match="match", u_distance="distance", u_own="INV"),
        "dtof_pool_engine": module(u_match="match"), "match": module(u_a="INV"), "distance": module(u_b="INV")}}


class PartCosts(unittest.TestCase):
    def test_every_scope_below_the_top_is_a_part(self) -> None:
        found = part_costs._instances(design())
        self.assertEqual(found, {"p0": ("quad", ""), "p0.p1": ("quad", "u_column"), "p0.p1.p0": ("quad", "u_match"),
                                 "p0.p1.p1": ("quad", "u_distance"), "p1": ("engine", ""), "p1.p0": ("engine", "u_match")})

    def test_the_counting_has_the_same_scopes(self) -> None:
        counted = design()
        activity.name_for_counting(counted)
        self.assertEqual(set(activity.scopes_of(counted)) - {""}, set(part_costs._instances(design())))

    def test_a_part_has_its_instances_in_all_quads_or_engines(self) -> None:
        # poolPointer: 50 quads, 6 engines. Each scope takes 3,000 fJ in 100 clocks, of which its SRAM takes 1,000 fJ.
        pool = configuration.load(ROOT / "configurations.toml")["poolpointer"]
        mapped = design()
        for one in mapped["modules"].values():
            for instance in one["cells"].values():
                instance["type"] = instance["type"].replace("INV", "INV_X1")
        mapped["modules"]["match"]["cells"] |= {"u_r": {"type": "DFF_X1", "connections": {}, "port_directions": {}}}
        scopes = {path: Scope(kind) for path, kind in activity.scopes_of({"modules": mapped["modules"]}).items()}
        named = {"p0": "dtof_pool_quad", "p0.p1": "column", "p0.p1.p0": "match", "p0.p1.p1": "distance", "p1": "dtof_pool_engine", "p1.p0": "match"}
        scopes |= {path: Scope(kind) for path, kind in named.items()}
        said: list[str] = []
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "typical.lib").write_text(standard_cells.library(standard_cells.TYPICAL), encoding="utf-8")
            cells = library.read(Path(folder) / "typical.lib")
            leak = {one.name: one.number("cell_leakage_power") for one in liberty.read(cells.path).children("cell")}
            case = SimpleNamespace(configuration=SimpleNamespace(name="small"))
            with mock.patch.object(part_costs, "elaborate") as elaborate, \
                    mock.patch.object(part_costs, "map_to_cells", return_value=mapped) as map_to_cells, \
                    mock.patch.object(part_costs.scene_power, "small_case", return_value=case), \
                    mock.patch.object(part_costs.scene_power, "count_activity", return_value=Activity(scopes, {STREAMING: 100})), \
                    mock.patch.object(activity, "energy", return_value=Energy(nets=2000.0, sram=1000.0)):
                parts = part_costs.measure(pool, part_of(Technology, typical=cells), Path(folder), 1, said.append)
            part_costs.write_csv(Path(folder) / "parts.csv", parts)
            lines = (Path(folder) / "parts.csv").read_text(encoding="utf-8").splitlines()
        self.assertEqual(elaborate.call_args.args[0], case.configuration)
        self.assertEqual(elaborate.call_args.args[3], part_costs.KEPT_MODULES)
        self.assertEqual(map_to_cells.call_args.args[3], mapping.efforts(pool)[0])
        found = {(part.block, part.instance): part for part in parts}
        self.assertEqual(list(found), [("quad", ""), ("quad", "SRAM"), ("quad", "u_column"), ("quad", "u_distance"), ("quad", "u_match"),
                                       ("engine", ""), ("engine", "SRAM"), ("engine", "u_match")])
        match_area = cells.area["INV_X1"] + cells.area["DFF_X1"]
        match_mw = (2000 / 100 + cells.clock_energy_fj["DFF_X1"]) * 330e-6 + (leak["INV_X1"] + leak["DFF_X1"]) * 1e-6
        for times, block in ((50, "quad"), (6, "engine")):
            self.assertAlmostEqual(found[block, "u_match"].area_um2, times * match_area)
            for light in ("day", "dusk"):
                self.assertAlmostEqual(found[block, "u_match"].power_mw[light], times * match_mw, places=9)
        self.assertAlmostEqual(found["quad", "u_distance"].area_um2, 50 * cells.area["INV_X1"])
        self.assertAlmostEqual(found["quad", "u_distance"].power_mw["day"], 50 * (20 * 330e-6 + leak["INV_X1"] * 1e-6), places=9)
        # What is in no part of the quad has an inverter; its SRAM and its column leak elsewhere.
        self.assertAlmostEqual(found["quad", ""].power_mw["day"], 50 * (20 * 330e-6 + leak["INV_X1"] * 1e-6), places=9)
        for block, times, scopes_of_block, size in (("quad", 50, 4, Size(1, 100, 232, 8)), ("engine", 6, 2, Size(1, 160, 33))):
            self.assertAlmostEqual(found[block, "SRAM"].area_um2, times * sram_model.macro(size).area)
            self.assertAlmostEqual(found[block, "SRAM"].power_mw["day"], times * scopes_of_block * 10 * 330e-6, places=9)
        total = sum(part.power_mw["day"] for part in parts)
        self.assertEqual(said, [f"poolpointer, {light}: {total:.1f} mW" for light in ("day", "dusk")])
        self.assertEqual(lines[0], "block,instance,area_um2,day_mw,dusk_mw")
        mw = f"{found['quad', 'u_match'].power_mw['day']:.3f}"
        self.assertEqual(lines[5], f"quad,u_match,{50 * match_area:.0f},{mw},{mw}")
        self.assertEqual(len(lines), 9)


if __name__ == "__main__":
    unittest.main()
