#!/usr/bin/env python3
"""Plots a run: map and trajectory from above, position over time with the truth, event and angular rates.

plot_run.py LOG MAP TRAJECTORY.tum PICTURE.png       (TRAJECTORY: of `evit run`; evit_read lies in tools/python)
"""
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "python"))
import evit_read

log_file, map_file, trajectory_file, picture = sys.argv[1:5]

# %% Read: times are microseconds, positions metres in the map frame.
log = evit_read.read_log(log_file)
points = evit_read.read_map(map_file)
track = evit_read.read_trajectory(trajectory_file)
begin = min(log[stream]["t"][0] for stream in ("events", "imu") if len(log[stream]["t"]))  # as in the pictures of `evit run`


def seconds(t):
    return (t - begin) * 1e-6


# %% Plot.
figure, (above, along, rates) = plt.subplots(3, 1, figsize=(8, 11))
above.plot(points[:, 0], points[:, 1], ".", markersize=0.5, color="0.7")
above.plot(track["position"][:, 0], track["position"][:, 1], color="tab:blue")
above.set(xlabel="x, m", ylabel="y, m", aspect="equal", title="map and trajectory from above")

for k, axis in enumerate("xyz"):
    along.plot(seconds(track["t"]), track["position"][:, k], label=axis)
    along.plot(seconds(log["truth"]["t"]), log["truth"]["position"][:, k], "k:", linewidth=1)
along.set(xlabel="s since the start of the log", ylabel="m", title="position; dotted: truth")
along.legend()

counts, edges = np.histogram(seconds(log["events"]["t"]), bins=200)
rates.plot(edges[:-1], counts / np.diff(edges) * 1e-6, label="million events/s")
rates.plot(seconds(log["imu"]["t"]), np.linalg.norm(log["imu"]["gyro"], axis=1), label="angular rate, rad/s")
rates.set(xlabel="s since the start of the log")
rates.legend()
figure.tight_layout()
figure.savefig(picture, dpi=100)
print(f"{picture}: {len(track['t'])} poses, {len(log['events']['t'])} events, {len(points)} points")
