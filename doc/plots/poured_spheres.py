"""The picture of spheres poured into a box: three states, the floor's force, what the contact solver left.

Usage: poured_spheres.py OUTPUT_DIR
"""

import sys

import numpy as np

from akmon_io import read_frames, read_history, read_pvd
from render import draw_frames
from style import EXACT, NUMERICAL, plt, save


def plot_force(ax, history):
    """The force of the spheres on the floor, averaged over a fiftieth of the run."""
    mean = np.ones(max(1, len(history["time"]) // 50))
    time, force = (np.convolve(history[name], mean / len(mean), mode="valid") for name in ("time", "floor.force_z"))
    ax.plot(time, force, color=NUMERICAL)
    ax.set(ylabel="force on the floor (N)")


def plot_gaps(ax, history):
    """Largest penetration of each row; nothing below what a logarithm shows."""
    ax.semilogy(history["time"], np.maximum(history["max_penetration_rel"], 1e-17), color=EXACT, linewidth=0.8)
    ax.set(xlabel="time (s)", ylabel="penetration / cell size", ylim=(1e-12, 1e-5))


def main(directory):
    n_frames = len(read_pvd(directory))
    frames = read_frames(directory, (0, n_frames // 4, n_frames - 1))
    figure = plt.figure(figsize=(12, 4.2))
    mesh_part, graph_part = figure.subfigures(1, 2, width_ratios=(2, 1), wspace=0.02)
    draw_frames(mesh_part, list(mesh_part.subplots(1, len(frames))), frames, "von_mises")
    upper, lower = graph_part.subplots(2, 1, sharex=True)
    history = read_history(directory)
    plot_force(upper, history)
    plot_gaps(lower, history)
    save(figure, directory, "poured_spheres.png")


if __name__ == "__main__":
    main(sys.argv[1])
