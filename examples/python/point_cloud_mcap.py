# SPDX-License-Identifier: Apache-2.0
# %% [markdown]
# # Point clouds for ROS 2
#
# Frames of a moving box as sensor_msgs/msg/PointCloud2 in an MCAP file of the profile `ros2`. Neither ROS nor a library is needed: the
# format is a few records (https://mcap.dev/spec). A test reads the file by Foxglove's readers.

# %%
import struct
import sys
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

import dtof

as_script = "ipykernel" not in sys.modules  # a notebook's arguments are those of Jupyter
out = Path(sys.argv[1] if as_script and len(sys.argv) == 2 else "build/python_examples")
out.mkdir(parents=True, exist_ok=True)

# %% [markdown]
# ## The message
#
# The schema is the text of the message's definition and of those that it refers to. A message is CDR, little-endian: every number begins
# at a multiple of its size, counted from behind the four bytes of the encapsulation.

# %%
TYPE = "sensor_msgs/msg/PointCloud2"
SCHEMA = """std_msgs/Header header
uint32 height
uint32 width
sensor_msgs/PointField[] fields
bool is_bigendian
uint32 point_step
uint32 row_step
uint8[] data
bool is_dense
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: sensor_msgs/PointField
uint8 INT8 = 1
uint8 UINT8 = 2
uint8 INT16 = 3
uint8 UINT16 = 4
uint8 INT32 = 5
uint8 UINT32 = 6
uint8 FLOAT32 = 7
uint8 FLOAT64 = 8
string name
uint32 offset
uint8 datatype
uint32 count
"""
FLOAT32 = 7
FIELDS = ("x", "y", "z", "intensity")
RECORD = np.dtype([(name, "<f4") for name in FIELDS])


class Cdr:
    """Bytes of a message."""

    def __init__(self) -> None:
        self.body = bytearray()

    def number(self, form: str, value: int) -> None:
        self.body += bytes(-len(self.body) % struct.calcsize(form)) + struct.pack(f"<{form}", value)

    def sequence(self, data: bytes) -> None:
        self.number("I", len(data))
        self.body += data

    def string(self, text: str) -> None:
        self.sequence(text.encode("utf-8") + b"\0")

    def message(self) -> bytes:
        return b"\0\1\0\0" + bytes(self.body)  # the encapsulation: CDR, little-endian


def point_cloud2(points: npt.NDArray[Any], time_ns: int, frame_id: str) -> bytes:
    """`points`: records of RECORD."""
    cdr = Cdr()
    cdr.number("i", time_ns // 10**9)
    cdr.number("I", time_ns % 10**9)
    cdr.string(frame_id)
    cdr.number("I", 1)  # height: the points have no order of rows and columns, for pixels without a distance have none
    cdr.number("I", len(points))
    cdr.number("I", len(FIELDS))
    for name in FIELDS:
        cdr.string(name)
        cdr.number("I", int(RECORD.fields[name][1]) if RECORD.fields is not None else 0)
        cdr.number("B", FLOAT32)
        cdr.number("I", 1)
    cdr.number("B", 0)  # is_bigendian
    cdr.number("I", RECORD.itemsize)
    cdr.number("I", RECORD.itemsize * len(points))
    cdr.sequence(points.tobytes())
    cdr.number("B", 1)  # is_dense: no point is NaN
    return cdr.message()


# %% [markdown]
# ## The file
#
# Every message is a chunk of its own, with an index, so that a viewer can seek. At the end stand copies of schema and channel, the
# chunks' index, statistics and, for a reader that begins at the end, where all that begins.

# %%
MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA_RECORD, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX, STATISTICS, SUMMARY_OFFSET, DATA_END = (
    1, 2, 3, 4, 5, 6, 7, 8, 11, 14, 15)  # fmt: skip
ID = 1  # of the one schema, and of the one channel


def prefixed(data: bytes | str) -> bytes:
    data = data.encode("utf-8") if isinstance(data, str) else data
    return struct.pack("<I", len(data)) + data


def record(opcode: int, content: bytes) -> bytes:
    return struct.pack("<BQ", opcode, len(content)) + content


class PointCloudFile:
    """An MCAP file with one channel of point clouds; for `with`."""

    def __init__(self, file: Path, topic: str, frame_id: str) -> None:
        self.stream = file.open("wb")
        self.frame_id = frame_id
        self.position = self.data_crc = 0
        self.times: list[int] = []
        self.indices = b""
        self.definitions = (record(SCHEMA_RECORD, struct.pack("<H", ID) + prefixed(TYPE) + prefixed("ros2msg") + prefixed(SCHEMA)),
                            record(CHANNEL, struct.pack("<HH", ID, ID) + prefixed(topic) + prefixed("cdr") + prefixed(b"")))
        self.put(MAGIC + record(HEADER, prefixed("ros2") + prefixed("dtof-readout")))

    def put(self, data: bytes) -> int:
        """Where the data begins."""
        begin = self.position
        self.stream.write(data)
        self.position += len(data)
        self.data_crc = zlib.crc32(data, self.data_crc)
        return begin

    def write(self, points: npt.NDArray[Any], time_ns: int) -> None:
        message = struct.pack("<HIQQ", ID, len(self.times), time_ns, time_ns) + point_cloud2(points, time_ns, self.frame_id)
        before = b"".join(self.definitions) if not self.times else b""  # the first chunk has the definitions, too
        records = before + record(MESSAGE, message)
        chunk = record(CHUNK, struct.pack("<QQQI", time_ns, time_ns, len(records), zlib.crc32(records)) + prefixed("")
                       + struct.pack("<Q", len(records)) + records)
        index = record(MESSAGE_INDEX, struct.pack("<H", ID) + prefixed(struct.pack("<QQ", time_ns, len(before))))
        begin = self.put(chunk)
        index_begin = self.put(index)
        self.indices += record(CHUNK_INDEX, struct.pack("<QQQQ", time_ns, time_ns, begin, len(chunk))
                               + prefixed(struct.pack("<HQ", ID, index_begin)) + struct.pack("<Q", len(index)) + prefixed("")
                               + struct.pack("<QQ", len(records), len(records)))
        self.times.append(time_ns)

    def close(self) -> None:
        self.put(record(DATA_END, struct.pack("<I", self.data_crc)))
        count, first, last = len(self.times), min(self.times, default=0), max(self.times, default=0)
        statistics = record(STATISTICS, struct.pack("<QHIIIIQQ", count, 1, 1, 0, 0, count, first, last) + prefixed(struct.pack("<HQ", ID, count)))
        groups = ((SCHEMA_RECORD, self.definitions[0]), (CHANNEL, self.definitions[1]), (STATISTICS, statistics), (CHUNK_INDEX, self.indices))
        begin, summary, offsets = self.position, b"", b""
        for opcode, group in groups:
            if group:
                offsets += record(SUMMARY_OFFSET, struct.pack("<BQQ", opcode, begin + len(summary), len(group)))
                summary += group
        footer = struct.pack("<QQ", begin, begin + len(summary))
        crc = zlib.crc32(summary + offsets + struct.pack("<BQ", FOOTER, len(footer) + 4) + footer)
        self.put(summary + offsets + record(FOOTER, footer + struct.pack("<I", crc)) + MAGIC)
        self.stream.close()

    def __enter__(self) -> "PointCloudFile":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


# %% [markdown]
# ## The frames
#
# A box comes nearer in front of a wall. x points right, y down, z ahead: what ROS calls an optical frame (REP 103). The intensity is the
# read-out's confidence.

# %%
FRAMES = 5
FRAME_RATE = 30
TOPIC, FRAME_ID = "/dtof/points", "dtof_optical_frame"
READOUT = "poolpointer"
sensor = dtof.Sensor("thesis").replace(acquisitions=2000)
frames: list[dtof.Frame] = []
with PointCloudFile(out / "point_cloud.mcap", TOPIC, FRAME_ID) as clouds:
    for number in range(FRAMES):
        depth = np.full((32, 48), 4.0)
        depth[8:24, 16:32] = 2.5 - 0.2 * number
        scene = dtof.Scene.from_depth(depth)
        tables: str | dict[str, dtof.LookupTable | None] = {READOUT: frames[0][READOUT].table} if frames else "flat"  # fitted once
        frames.append(dtof.frame(scene, sensor, READOUT, klux=10.0, table=tables, frame=number))
        made = frames[-1][READOUT]
        places, known = dtof.point_cloud(made.depth_m, sensor.degrees_per_pixel)
        points = np.empty(len(places), dtype=RECORD)
        for axis, name in enumerate(FIELDS[:3]):
            points[name] = places[:, axis]
        points["intensity"] = made.confidence[known]
        clouds.write(points, number * 10**9 // FRAME_RATE)
        print(f"frame {number}: {len(points)} points, the box at {float(np.median(made.depth_m[8:24, 16:32])):.2f} m")
print(out / "point_cloud.mcap")
