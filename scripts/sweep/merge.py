# SPDX-License-Identifier: Apache-2.0
"""Merges the rows of all points to one table, in the order of the axes.

Every batch is checked: it must be complete, belong to the present program, command and inputs (by its name), and have exactly the points of
the description, each once. So the table is the same byte for byte, wherever and however often jobs ran.
"""

import csv
import io
import json
from pathlib import Path

import plan
from run_batch import checksum


def read_batch(path: Path, batch: plan.Batch) -> tuple[list[str], list[dict]]:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
        header, points = content["header"], content["points"]
    except OSError as error:
        raise plan.SweepError(f"{path}: {error.strerror}") from None
    except (ValueError, KeyError, TypeError):
        raise plan.SweepError(f"{path}: not a whole batch: remove it and run the sweep again") from None
    if content.get("batch") != batch.name:
        raise plan.SweepError(f"{path}: is of other inputs ({content.get('batch')}): remove it and run the sweep again")
    if content.get("checksum") != checksum(header, points):
        raise plan.SweepError(f"{path}: was changed after it was written: remove it and run the sweep again")
    found = [[point["coordinates"], point["seed"]] for point in points]
    wanted = [[[list(pair) for pair in point.coordinates], point.seed] for point in batch.points]
    if found != wanted:
        raise plan.SweepError(f"{path}: has not exactly its batch's points: remove it and run the sweep again")
    return header, points


def merged(sweep: plan.Sweep, folder: Path) -> str:
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    columns: list[str] = []
    for number in range(sweep.batches):
        batch = sweep.batch(number)
        path = plan.batch_file(folder, batch)
        header, points = read_batch(path, batch)
        if not columns:
            columns = header
            writer.writerow([*sweep.header, *columns])
        elif header != columns:
            raise plan.SweepError(f"{path}: its table has other columns than the first batch's")
        for point in points:
            start = [value for _, value in point["coordinates"]] + [str(point["seed"])]
            writer.writerows([*start, *row] for row in point["rows"])
    return text.getvalue()
