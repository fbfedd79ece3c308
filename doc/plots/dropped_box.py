"""The box dropped on its corner: slab and box at the deepest dent, velocity and force, penetration.

Usage: dropped_box.py OUTPUT_DIR       writes OUTPUT_DIR/dropped_box.png
"""

import sys

import numpy as np

from akmon_io import read_history, read_pvd, read_vtu
from style import NUMERICAL, plt, save

START, NORMAL, SIZE = np.array([0.11, 0.07, 0.18]), np.array([1, 0.9, 0.8]), 0.2


def rotation(vector):
    """The matrix that turns by a rotation vector."""
    angle = np.linalg.norm(vector)
    if angle == 0:
        return np.eye(3)
    x, y, z = vector / angle
    K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K


def orientations(history):
    """The box's orientation at every row: the initial one turned on by the spin."""
    time = history["time"]
    spin = np.column_stack([history[f"box.spin_{axis}"] for axis in "xyz"])
    normal = NORMAL / np.linalg.norm(NORMAL)
    axis = np.cross([0, 0, 1], normal)
    R = rotation(axis / np.linalg.norm(axis) * np.arccos(normal[2]))
    result = [R]
    for i in range(1, len(time)):
        R = rotation(0.5 * (spin[i] + spin[i - 1]) * (time[i] - time[i - 1])) @ R
        result.append(R)
    return result


def scene(ax, directory, history):
    """The top of the slab and the edges of the box where it turns round for the first time."""
    lowest = np.argmax(history["box.velocity_z"] > 0)
    time, path = min(read_pvd(directory), key=lambda frame: abs(frame[0] - history["time"][lowest]))
    row = np.argmin(abs(history["time"] - time))
    points, cells, data = read_vtu(path)
    top = cells[:, [4, 5, 6, 7]]
    place = points - data["displacement"]
    for quad in top[np.all(abs(place[top][:, :, 2]) < 1e-6, axis=1)]:
        ring = points[np.append(quad, quad[0])]
        ax.plot(*ring.T, color="0.45", linewidth=0.8)
    centre = START + [history[f"box.displacement_{axis}"][row] for axis in "xyz"]
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * SIZE / 2
    corners = centre + corners @ orientations(history)[row].T
    for i in range(8):
        for bit in (1, 2, 4):
            if not i & bit:
                ax.plot(*corners[[i, i | bit]].T, color=NUMERICAL, linewidth=1.6)
    ax.set(title=f"t = {time:.3f} s", xlim=(-0.3, 0.5), ylim=(-0.3, 0.5), zlim=(-0.1, 0.3))
    ax.set_box_aspect((0.8, 0.8, 0.4), zoom=1.4)
    ax.view_init(12, -62)
    ax.set_axis_off()


def main(directory):
    history = read_history(directory)
    figure = plt.figure(figsize=(13, 3.8))
    scene(figure.add_subplot(1, 3, 1, projection="3d"), directory, history)
    ax = figure.add_subplot(1, 3, 2)
    ax.plot(history["time"], history["box.velocity_z"], color=NUMERICAL, label="velocity (m/s)")
    ax.plot(history["time"], -1e-3 * history["box.force_z"], color="#3b6fb6", label="force (kN)")
    ax.set(title="Box", xlabel="time (s)", ylim=(-4, 6))
    ax.legend()
    ax = figure.add_subplot(1, 3, 3)
    deep = history["max_penetration_rel"] > 0
    ax.semilogy(history["time"][deep], history["max_penetration_rel"][deep], ".", color=NUMERICAL, markersize=3)
    ax.axhline(1e-10, color="0.5", linewidth=1)  # the tolerance
    ax.set(title="Penetration over cell size, every step", xlabel="time (s)", ylim=(1e-15, 1e-7))
    save(figure, directory, "dropped_box.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
