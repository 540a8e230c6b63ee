# SPDX-License-Identifier: Apache-2.0
"""Sweeps: points, seeds and batches follow from the description; batches that are not what they should be are noticed.
Snakemake and Slurm have scripts/sweep/slurm_test.py (make sweep-test)."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import merge
import plan
import run_batch
from slurm import job_status

SWEEP = Path(__file__).resolve().parent.parent
ROOT = SWEEP.parent.parent
DESCRIPTION = """\
name = "small"
command = "/usr/bin/python3 program.py {kind} {light} {seed} {out}"
table = "table.csv"
inputs = ["program.py"]
batch = 2
seed_of = ["light", "repetition"]

[axes]
light = [2, 0.5]
repetition = [1, 2]
kind = ["a", "b"]
"""


class Folder(unittest.TestCase):
    def setUp(self) -> None:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = Path(temporary.name)
        (self.root / "program.py").write_text("print()\n", encoding="utf-8")
        self.path = self.root / "sweep.toml"

    def load(self, description: str = DESCRIPTION) -> plan.Sweep:
        self.path.write_text(description, encoding="utf-8")
        return plan.load(self.path, self.root)

    def filled(self, sweep: plan.Sweep) -> list[Path]:
        """Batches as jobs leave them, with a row for each point."""
        files = []
        for number in range(sweep.batches):
            batch = sweep.batch(number)
            points = [{"coordinates": point.coordinates, "seed": point.seed, "rows": [[str(number), "x"]]}
                      for point in batch.points]
            run_batch.write(plan.batch_file(self.root, batch), batch, ["error", "note"], points)
            files.append(plan.batch_file(self.root, batch))
        return files


class Plan(Folder):
    def test_points_are_all_combinations_and_the_last_axis_changes_first(self) -> None:
        sweep = self.load()
        self.assertEqual((sweep.points, sweep.batches), (8, 4))
        self.assertEqual([[value for _, value in sweep.point(i).coordinates] for i in (0, 1, 2, 7)],
                         [["2", "1", "a"], ["2", "1", "b"], ["2", "2", "a"], ["0.5", "2", "b"]])
        self.assertEqual([p for number in range(4) for p in sweep.batch(number).points], [sweep.point(i) for i in range(8)])

    def test_seeds_follow_from_their_axes_alone(self) -> None:
        sweep = self.load()
        self.assertEqual(sweep.point(0).seed, sweep.point(1).seed)
        self.assertEqual(len({sweep.point(i).seed for i in range(8)}), 4)
        more = self.load(DESCRIPTION.replace('["a", "b"]', '["z", "a", "b"]').replace("[2, 0.5]", "[7, 2, 0.5]"))
        seeds = {p.coordinates: p.seed for p in map(more.point, range(more.points))}
        for i in range(8):
            self.assertEqual(seeds[sweep.point(i).coordinates], sweep.point(i).seed)
        self.assertTrue(all(0 < seed < 1 << 31 for seed in seeds.values()))

    def test_numbers_keep_all_their_digits(self) -> None:
        sweep = self.load(DESCRIPTION.replace("[2, 0.5]", "[2.0, 0.1234567, 1234567.5, 1e-7]"))
        self.assertEqual(sweep.axes[0][1], ("2", "0.1234567", "1234567.5", "1e-07"))

    def test_inputs_may_be_anywhere(self) -> None:
        name = self.load(DESCRIPTION.replace('"program.py"]', f'"program.py", "{sys.executable}"]')).batch(0).name
        self.assertNotEqual(name, self.load().batch(0).name)

    def test_a_batch_is_named_after_everything_it_comes_from(self) -> None:
        names = {self.load().batch(0).name}
        names.add(self.load(DESCRIPTION.replace("{out}", "--fast {out}")).batch(0).name)
        names.add(self.load(DESCRIPTION.replace("[1, 2]", "[3, 2]")).batch(0).name)
        (self.root / "program.py").write_text("print(1)\n", encoding="utf-8")
        names.add(self.load().batch(0).name)
        self.assertEqual(len(names), 4)
        self.assertEqual(self.load().batch(0).name, self.load(DESCRIPTION.replace("[2, 0.5]", "[2, 0.5, 9]")).batch(0).name)

    def test_what_is_wrong_is_named(self) -> None:
        for old, new, message in (("batch = 2", "batch = 0", "'batch' must be"), ("table =", "tables =", "unknown key 'tables'"),
                                  ("{out}", "", "'command' must have {out}"), ("{seed}", "{sed}", "{sed}, which is no axis"),
                                  ("[2, 0.5]", "[2, 2]", "axis 'light': a value stands there twice"),
                                  ("[2, 0.5]", "[]", "axis 'light': must be a list"),
                                  ("[2, 0.5]", "[true]", "axis 'light': values are"),
                                  ('"repetition"]', '"repeat"]', "names the axis 'repeat'"),
                                  ('["light", "repetition"]', '["light"]', "axis 'repetition' is neither"),
                                  ('["light", "repetition"]', "3", "'seed_of' must be a list of axes"),
                                  ("{kind} ", "{kind:3} ", "neither ':' nor '!'"), ("{kind} ", "{kind!r} ", "neither ':' nor"),
                                  ("{kind} ", "{kind ", "'command': unexpected '{'"), ("{kind} ", "'{kind} ", "'command': No closing"),
                                  ("{kind} ", "{} ", "has {}, which is no axis"),
                                  ('"program.py"]', '"program.cc"]', "program.cc: No such file"), ("[axes]", "[axes", "")):
            with self.subTest(new=new[:20]), self.assertRaises(plan.SweepError) as caught:
                self.load(DESCRIPTION.replace(old, new))
            self.assertIn(message, str(caught.exception))
            self.assertEqual(len(str(caught.exception).splitlines()), 1)

    def test_too_many_points_are_refused(self) -> None:
        with mock.patch.object(plan, "MOST_POINTS", 7), self.assertRaisesRegex(plan.SweepError, "8 points, but at most 7"):
            self.load()

    def test_committed_sweeps_are_legal(self) -> None:
        for path in SWEEP.glob("*.toml"):
            description = path.read_text(encoding="utf-8")
            with self.subTest(path=path.name):
                for name in plan.tomllib.loads(description)["inputs"]:
                    (self.root / name).parent.mkdir(parents=True, exist_ok=True)
                    (self.root / name).touch()
                self.assertGreater(plan.load(path, self.root).points, 1)


class Merge(Folder):
    def test_the_table_has_coordinates_before_the_commands_columns(self) -> None:
        sweep = self.load()
        self.filled(sweep)
        lines = merge.merged(sweep, self.root).splitlines()
        self.assertEqual(len(lines), 9)
        self.assertEqual(lines[0], "light,repetition,kind,seed,error,note")
        self.assertEqual(lines[3], f"2,2,a,{sweep.point(2).seed},1,x")

    def expect(self, message: str) -> None:
        with self.assertRaises(plan.SweepError) as caught:
            merge.merged(self.sweep, self.root)
        self.assertIn(message, str(caught.exception))

    def test_batches_that_are_not_right_are_noticed(self) -> None:
        self.sweep = self.load()
        file = self.filled(self.sweep)[1]
        whole = file.read_text(encoding="utf-8")
        file.write_text(whole[:-20], encoding="utf-8")
        self.expect("not a whole batch")
        file.write_text("[]", encoding="utf-8")
        self.expect("not a whole batch")
        file.unlink()
        self.expect("No such file")
        content = json.loads(whole)
        content["points"].append(content["points"][0])
        file.write_text(json.dumps(content), encoding="utf-8")
        self.expect("was changed after")
        content["checksum"] = run_batch.checksum(content["header"], content["points"])
        file.write_text(json.dumps(content), encoding="utf-8")
        self.expect("not exactly its batch's points")
        older = json.loads(whole) | {"batch": "0" * 32}
        file.write_text(json.dumps(older), encoding="utf-8")
        self.expect("of other inputs")
        changed = json.loads(whole)
        changed["points"][0]["rows"][0][0] = "7"
        file.write_text(json.dumps(changed), encoding="utf-8")
        self.expect("was changed after")
        file.write_text(whole, encoding="utf-8")
        merge.merged(self.sweep, self.root)

    def test_columns_must_agree(self) -> None:
        self.sweep = self.load()
        self.filled(self.sweep)
        batch = self.sweep.batch(3)
        points = [{"coordinates": point.coordinates, "seed": point.seed, "rows": [["1"]]} for point in batch.points]
        run_batch.write(plan.batch_file(self.root, batch), batch, ["error"], points)
        self.expect("other columns")

    def test_a_batch_of_an_older_program_is_not_looked_at(self) -> None:
        self.sweep = self.load()
        self.filled(self.sweep)
        (self.root / "program.py").write_text("print(2)\n", encoding="utf-8")
        self.sweep = self.load()
        self.expect("No such file")


class Run(unittest.TestCase):
    def run_batch(self, description: str, number: int = 0) -> tuple[subprocess.CompletedProcess, Path, plan.Sweep]:
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        folder = Path(temporary.name)
        path = folder / "sweep.toml"
        path.write_text(description, encoding="utf-8")
        sweep = plan.load(path, ROOT)
        batch = sweep.batch(number)
        result = subprocess.run([sys.executable, str(SWEEP / "run_batch.py"), str(path), str(folder), str(number), batch.name],
                                capture_output=True, text=True, check=False)
        return result, plan.batch_file(folder, batch), sweep

    def description(self, command: str) -> str:
        return (f'name = "run"\ncommand = \'/bin/sh -c "{command}"\'\ntable = "t.csv"\ninputs = ["LICENSE"]\nbatch = 3\n'
                '[axes]\nx = [1, 2]\n')

    def test_a_batch_has_the_rows_of_its_points(self) -> None:
        result, file, sweep = self.run_batch(self.description("echo value > {out}/t.csv; echo {x} >> {out}/t.csv"))
        self.assertEqual(result.returncode, 0, result.stderr)
        header, points = merge.read_batch(file, sweep.batch(0))
        self.assertEqual(header, ["value"])
        self.assertEqual([point["rows"] for point in points], [[["1"]], [["2"]]])

    def test_a_program_that_changes_meanwhile_leaves_no_file(self) -> None:
        with tempfile.NamedTemporaryFile() as program:
            description = self.description(f"echo value > {{out}}/t.csv; echo {{x}} | tee -a {{out}}/t.csv >> {program.name}")
            result, file, _ = self.run_batch(description.replace("LICENSE", program.name))
        self.assertEqual(result.returncode, 1)
        self.assertIn("changed while the sweep ran", result.stderr)
        self.assertFalse(file.parent.exists())

    def test_a_failure_leaves_no_file(self) -> None:
        for command, message in (("echo {out} {x}; echo no light >&2; exit 3", "exit 3: no light"),
                                 ("true {out} {x}", "the command left no table"),
                                 ("echo {x} > {out}/t.csv", "table has no rows"),
                                 ("echo {x} > {out}/t.csv; echo 1 >> {out}/t.csv", "differ in their columns"),
                                 ("echo x > {out}/t.csv; echo {x} >> {out}/t.csv", "has a column 'x', too")):
            with self.subTest(command=command):
                result, file, _ = self.run_batch(self.description(command))
                self.assertEqual(result.returncode, 1)
                self.assertIn(message, result.stderr)
                self.assertEqual(list(file.parent.parent.glob("*/*")), [])


class JobStatus(unittest.TestCase):
    def test_of_what_slurm_prints(self) -> None:
        for answer, status in (("JobId=4 JobState=RUNNING Reason=None", "running"), ("JobState=PENDING", "running"),
                               ("JobId=4 JobState=COMPLETED", "success"), ("JobState=CANCELLED", "failed"),
                               ("JobState=NODE_FAIL", "failed")):
            self.assertEqual(job_status.status(answer), status)
        for error, status in (("slurm_load_jobs error: Invalid job id specified", "failed"),
                              ("slurm_load_jobs error: Unable to contact slurm controller (connect failure)", "running")):
            self.assertEqual(job_status.status("", error), status)


if __name__ == "__main__":
    unittest.main()
