"""Reads EVIT's files with numpy alone: logs, maps, trajectories, results of `evit run`.

    import evit_read
    log = evit_read.read_log("boxes.lcmlog")        # log["events"]["t"], ["x"], ["y"], ["p"]; log["imu"]["gyro"], ...
    points = evit_read.read_map("boxes.pcd")        # n x 3, m
    run = evit_read.read_result("boxes_result")     # run["trajectory"]["position"], run["report"]["..."]

Times are int64 microseconds, positions metres in the map frame, orientations quaternions x y z w (body to map), angular rates
rad/s, accelerations m/s^2 in the body frame. All raise ValueError naming the file and what is wrong with it.
"""

import json
import pathlib
import struct

import numpy as np

_SYNC = 0xEDA1DA01
_MAX_PACKET = 100_000  # events or samples in one message


def log_messages(path):
    """(channel, log time in us, bytes) of each whole message of an LCM log."""
    data = pathlib.Path(path).read_bytes()
    at = 0
    while at + 28 <= len(data):
        sync, _, utime, n_channel, n = struct.unpack_from(">IqqII", data, at)
        if sync != _SYNC:
            raise ValueError(f"{path}: byte {at}: no message begins here; is it an LCM log, and whole?")
        begin = at + 28 + n_channel
        if begin + n > len(data):
            return  # cut off
        yield data[at + 28 : begin].decode(), utime, data[begin : begin + n]
        at = begin + n
    if at == 0:
        raise ValueError(f"{path}: holds no message")


def _numbers(data, at, kind, n):
    return np.frombuffer(data, kind, n, at), at + n * np.dtype(kind).itemsize


def _event_packet(data):
    utime, _, _, n = struct.unpack_from(">qqqi", data, 8)
    if not 0 <= n <= _MAX_PACKET or len(data) != 36 + 9 * n:
        raise ValueError("an EVENTS message has the wrong length")
    dt, at = _numbers(data, 36, ">i4", n)
    x, at = _numbers(data, at, ">i2", n)
    y, at = _numbers(data, at, ">i2", n)
    p, at = _numbers(data, at, "u1", n)
    return utime + dt.astype(np.int64), x.astype(np.int32), y.astype(np.int32), p


def _imu_batch(data):
    n = struct.unpack_from(">i", data, 32)[0]
    if not 0 <= n <= _MAX_PACKET or len(data) != 36 + 56 * n:
        raise ValueError("an IMU message has the wrong length")
    t, at = _numbers(data, 36, ">i8", n)
    gyro, at = _numbers(data, at, ">f8", 3 * n)
    accel, at = _numbers(data, at, ">f8", 3 * n)
    return t.astype(np.int64), gyro.reshape(n, 3).astype(float), accel.reshape(n, 3).astype(float)


def _body_pose(data):
    if len(data) != 8 + 24 + 80:
        raise ValueError("a pose message has the wrong length")
    values, _ = _numbers(data, 32, ">f8", 10)
    return struct.unpack_from(">q", data, 8)[0], values.astype(float)


def _poses(messages):
    values = np.array([v for _, v in messages]).reshape(-1, 10)
    return {
        "t": np.array([t for t, _ in messages], np.int64),
        "position": values[:, 0:3],
        "orientation": values[:, 3:7],
        "velocity": values[:, 7:10],
    }


def read_log(path, prefix=""):
    """Events, IMU, truth and poses of a log of `evit import` or lcm-logger; what it does not hold is empty."""
    events, imu, poses = [], [], {"GROUND_TRUTH": [], "BODY_POSE": []}
    for channel, _, data in log_messages(path):
        try:
            if channel == prefix + "EVENTS":
                events.append(_event_packet(data))
            elif channel == prefix + "IMU":
                imu.append(_imu_batch(data))
            elif channel.startswith(prefix) and channel[len(prefix) :] in poses:
                poses[channel[len(prefix) :]].append(_body_pose(data))
        except (struct.error, ValueError) as error:
            raise ValueError(f"{path}: {error}") from None
    kinds = (np.int64, np.int32, np.int32, np.uint8)
    columns = [np.concatenate(c) for c in zip(*events)] if events else [np.empty(0, k) for k in kinds]
    samples = [np.concatenate(c) for c in zip(*imu)] if imu else [np.empty(0, np.int64), np.empty((0, 3)), np.empty((0, 3))]
    return {
        "events": dict(zip("txyp", columns)),
        "imu": dict(zip(("t", "gyro", "accel"), samples)),
        "truth": _poses(poses["GROUND_TRUTH"]),
        "poses": _poses(poses["BODY_POSE"]),
    }


def read_trajectory(path):
    """A TUM file: t (us), position (n x 3), orientation (n x 4)."""
    times, rows = [], []
    for number, line in enumerate(pathlib.Path(path).read_text().splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        if len(words) < 8:
            raise ValueError(f"{path}:{number}: expected t x y z qx qy qz qw")
        seconds, _, fraction = words[0].partition(".")
        times.append(int(seconds) * 1_000_000 + int((fraction + "000000")[:6]))
        rows.append([float(w) for w in words[1:8]])
    values = np.array(rows).reshape(-1, 7)
    return {"t": np.array(times, np.int64), "position": values[:, :3], "orientation": values[:, 3:]}


def read_map(path):
    """The points of a map as `evit map import` writes it (PCD, ASCII or binary): n x 3, m."""
    data = pathlib.Path(path).read_bytes()
    header, at = {}, 0
    while "DATA" not in header:
        end = data.find(b"\n", at)
        if end < 0:
            raise ValueError(f"{path}: is no PCD file; convert it with `evit map import {path} map.pcd`")
        words = data[at:end].decode("ascii", "replace").split()
        at = end + 1
        if words and not words[0].startswith("#"):
            header[words[0]] = words[1:]
    fields, how = header.get("FIELDS", []), header["DATA"][0]
    if not {"x", "y", "z"} <= set(fields) or how not in ("ascii", "binary"):
        raise ValueError(f"{path}: needs fields x y z, ASCII or binary; convert it with `evit map import {path} map.pcd`")
    if how == "ascii":
        table = np.array(data[at:].split(), float).reshape(-1, len(fields))
        return np.stack([table[:, fields.index(c)] for c in "xyz"], axis=1)
    kinds = {"F": "f", "I": "i", "U": "u"}
    counts = header.get("COUNT", ["1"] * len(fields))
    row = np.dtype([(f"{name}.{k}", kinds[kind] + size, (int(count),)) for k, (name, kind, size, count) in
                    enumerate(zip(fields, header["TYPE"], header["SIZE"], counts))])
    n = int(header["POINTS"][0])
    if len(data) - at < n * row.itemsize:
        raise ValueError(f"{path}: is cut off")
    table = np.frombuffer(data, row, n, at)
    return np.stack([table[f"{c}.{fields.index(c)}"][:, 0].astype(float) for c in "xyz"], axis=1)


def read_result(folder):
    """What `evit run` left in its folder: trajectory, smoothed (if there), report."""
    folder = pathlib.Path(folder)
    result = {"trajectory": read_trajectory(folder / "trajectory.tum")}
    if (folder / "smoothed.tum").exists():
        result["smoothed"] = read_trajectory(folder / "smoothed.tum")
    if (folder / "report.json").exists():
        result["report"] = json.loads((folder / "report.json").read_text())
    return result
