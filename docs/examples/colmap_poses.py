#!/usr/bin/env python3
"""Poses of COLMAP as `evit map build` reads them: in metres, with the z axis up.

colmap_poses.py SPARSE/images.txt PICTURES --distance A B METRES --out poses.tum

COLMAP knows neither the scale nor which way is up. METRES is the distance between the places from which the pictures
named A and B were taken. Up is what is up in the pictures on average; a tilt that remains is found by `evit calibrate`.
Writes poses.tum, and PICTURES/images.txt, which says which pose is whose. (COLMAP's own images.txt, as text: colmap
model_converter --output_type TXT. Pictures have to be undistorted, or have the `camera` block of a rig file.)
"""
import argparse
import pathlib
import sys

import numpy as np


def rotation(q):
    """3x3 of a quaternion w x y z."""
    w, x, y, z = np.asarray(q) / np.linalg.norm(q)
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def quaternion(r):
    """x y z w of a 3x3: the eigenvector of the largest eigenvalue (Bar-Itzhack, 2000)."""
    k = np.array([[r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
                  [0, r[1, 1] - r[0, 0] - r[2, 2], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]],
                  [0, 0, r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
                  [0, 0, 0, np.trace(r)]])
    return np.linalg.eigh(k, UPLO="U")[1][:, -1]


def read_images(file):
    """{name: (R_world_camera, position in the world)}: a row IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, then one of points."""
    poses = {}
    rows = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    for row in rows[::2]:
        words = row.split(maxsplit=9)
        if not words:
            continue
        try:
            numbers = [float(word) for word in words[1:8]]
            name = words[9]
        except (ValueError, IndexError):
            sys.exit(f"{file}: expected IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME, found: {row[:80]}")
        r = rotation(numbers[:4]).T
        poses[name] = r, -r @ np.array(numbers[4:])
    if len(poses) < 3:
        sys.exit(f"{file}: {len(poses)} pictures with poses; a map needs three or more")
    return poses


def upright(poses):
    """R_map_world that turns the mean of the cameras' up (their -y) to z, and leaves the first camera's heading along x."""
    up = -np.mean([r[:, 1] for r, _ in poses.values()], axis=0)
    if np.linalg.norm(up) < 0.5:
        sys.exit("the pictures do not agree on which way is up: hold the camera upright, or turn the poses yourself")
    z = up / np.linalg.norm(up)
    ahead = next(iter(poses.values()))[0][:, 2]
    if abs(ahead @ z) > 0.99:  # looks straight up or down
        ahead = next(iter(poses.values()))[0][:, 0]
    x = ahead - (ahead @ z) * z
    x /= np.linalg.norm(x)
    return np.array([x, np.cross(z, x), z])


parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("images", type=pathlib.Path, help="COLMAP's images.txt")
parser.add_argument("pictures", type=pathlib.Path, help="folder of the pictures")
parser.add_argument("--distance", nargs=3, metavar=("A", "B", "METRES"), required=True)
parser.add_argument("--out", type=pathlib.Path, required=True, help="TUM file to write: T_map_camera")
arguments = parser.parse_args()

poses = read_images(arguments.images)
names = sorted(poses)
for name in arguments.distance[:2]:
    if name not in poses:
        sys.exit(f"--distance: {arguments.images} has no pose of {name}; it has {names[0]} to {names[-1]}")
missing = [name for name in names if not (arguments.pictures / name).is_file()]
if missing:
    sys.exit(f"{arguments.pictures / missing[0]}: not there ({len(missing)} of {len(names)} pictures are missing)")
listing = arguments.pictures / "images.txt"
if listing.exists():
    sys.exit(f"{listing}: exists; move it away")
apart = np.linalg.norm(poses[arguments.distance[0]][1] - poses[arguments.distance[1]][1])
metres = float(arguments.distance[2])
if not (metres > 0 and apart > 0):
    sys.exit("--distance: expected two pictures from different places and the metres between them")

R_map_world, origin = upright(poses), poses[names[0]][1]
with arguments.out.open("w") as out, listing.open("w") as listed:
    out.write("# s x y z (m) qx qy qz qw, T_map_camera; from " + arguments.images.name + "\n")
    for k, name in enumerate(names):
        r, p = poses[name]
        row = [k, *(metres / apart * R_map_world @ (p - origin)), *quaternion(R_map_world @ r)]
        out.write(" ".join(f"{number:.9f}" for number in row) + "\n")
        listed.write(f"{k}.000000 {name}\n")
print(f"{arguments.out}: {len(names)} poses, scale {metres / apart:.4g} m; {listing}: which is whose")
