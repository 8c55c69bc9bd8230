#!/usr/bin/env python3
"""Prints the errors that trajectory_error_test.cc expects of its fixed case, computed apart from EVIT with numpy by the
definitions that evo documents (github.com/MichaelGrupp/evo, metrics.py and geometry.py): APE of E = ref^-1 est, RPE of
E = (ref_i^-1 ref_j)^-1 (est_i^-1 est_j) over all pairs `delta` frames apart, translation |t(E)| and rotation angle of E,
root mean square and maximum; alignment by Umeyama 1991, with and without scale."""
import numpy as np


def exp(w):
    angle = np.linalg.norm(w)
    if angle == 0:
        return np.eye(3)
    x, y, z = w / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def pose(r, p):
    t = np.eye(4)
    t[:3, :3], t[:3, 3] = r, p
    return t


def case():
    ref, est = [], []
    turn, shift = exp(np.array([0.2, -0.4, 1.0])), np.array([3.0, 4.0, 5.0])
    for k in range(401):
        s = 0.02 * k
        r = exp(np.array([0.3 * np.sin(s), 0.2 * np.cos(2 * s), 0.5 * s]))
        p = np.array([np.sin(s), np.cos(1.3 * s), 0.2 * s])
        ref.append(pose(r, p))
        e = 0.01 * np.array([np.sin(7 * s), np.cos(5 * s), np.sin(3 * s)])
        d = 0.01 * np.array([np.cos(9 * s), np.sin(11 * s), np.cos(4 * s)])
        est.append(pose(turn @ r @ exp(e), 0.97 * turn @ (p + d) + shift))
    return np.array(ref), np.array(est)


def umeyama(x, y, with_scale):
    mx, my = x.mean(1, keepdims=True), y.mean(1, keepdims=True)
    n = x.shape[1]
    u, d, v = np.linalg.svd((y - my) @ (x - mx).T / n)
    s = np.eye(3)
    if np.linalg.det(u) * np.linalg.det(v) < 0:
        s[2, 2] = -1
    r = u @ s @ v
    c = np.trace(np.diag(d) @ s) / ((x - mx) ** 2).sum() * n if with_scale else 1.0
    return r, my - c * r @ mx, c


def errors(e):
    # atan2: arccos loses half of the digits of small angles
    skew = np.stack([e[:, 2, 1] - e[:, 1, 2], e[:, 0, 2] - e[:, 2, 0], e[:, 1, 0] - e[:, 0, 1]], 1)
    angle = np.arctan2(np.linalg.norm(skew, axis=1), np.trace(e[:, :3, :3], axis1=1, axis2=2) - 1)
    t = np.linalg.norm(e[:, :3, 3], axis=1)
    return [np.sqrt((t**2).mean()), np.sqrt((angle**2).mean()), t.max(), angle.max()]


def main():
    ref, est = case()
    for name, align, scale in (("none", 0, 0), ("Umeyama", 1, 0), ("Umeyama with scale", 1, 1)):
        moved = est.copy()
        if align:
            r, t, c = umeyama(est[:, :3, 3].T, ref[:, :3, 3].T, bool(scale))
            moved[:, :3, 3] = (c * r @ est[:, :3, 3].T + t).T
            moved[:, :3, :3] = r @ est[:, :3, :3]
        print(f"{name:20}", *(f"{v:.12f}" for v in errors(np.linalg.inv(ref) @ moved)))
    for delta in (1, 50):
        step = lambda a: np.linalg.inv(a[:-delta]) @ a[delta:]
        print(f"RPE {delta} frames".ljust(20), *(f"{v:.12f}" for v in errors(np.linalg.inv(step(ref)) @ step(est))))


main()
