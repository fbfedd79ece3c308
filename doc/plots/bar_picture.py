"""The picture of a bar that hits a rigid wall (z = 0): mesh before, after and cut open, energies over time.

Cases in SI units.
"""

import numpy as np
from matplotlib.collections import PolyCollection

from akmon_io import read_frames, read_history
from history import plot_energies
from render import VIEW, choose_field, draw_frames
from style import plt, save


def cut_open(frame):
    """The half of the bar that was behind the plane y = 0 at the start."""
    time, points, cells, data = frame
    behind = (points - data["displacement"])[cells].mean(axis=1)[:, 1] > 0
    return time, points, cells[behind], data


def draw_wall(axes, half_width):
    """The wall below all meshes, and room for it."""
    corners = half_width * np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
    wall = (corners @ VIEW.T)[:, :2]
    for ax in axes:
        ax.add_collection(PolyCollection([wall], facecolors="#ecebe6", edgecolors="#b9b6ab", linewidths=0.7,
                                         zorder=0))
        (left, right), (bottom, top) = ax.get_xlim(), ax.get_ylim()
        ax.set_xlim(min(left, wall[:, 0].min()), max(right, wall[:, 0].max()))
        ax.set_ylim(min(bottom, wall[:, 1].min()), top)


def describe(frame):
    """Length and radius of the face, in the way of a caliper."""
    _, points, _, data = frame
    face = np.abs((points - data["displacement"])[:, 2]) < 1e-6 * np.ptp(points[:, 2])
    radius = np.hypot(points[face, 0], points[face, 1]).max()
    return f"L = {np.ptp(points[:, 2]):.5g} m, R = {radius:.5g} m, L/(2R) = {np.ptp(points[:, 2]) / (2 * radius):.4g}"


def draw_bar(directory, name):
    """Write DIRECTORY/NAME: the meshes coloured by plastic strain, and the energies."""
    first, last = read_frames(directory, (0, -1))
    frames = [first, last, cut_open(last)]
    figure = plt.figure(figsize=(12, 4.2))
    mesh_part, energy_part = figure.subfigures(1, 2, width_ratios=(1.75, 1), wspace=0.02)
    axes = list(mesh_part.subplots(1, len(frames)))
    draw_frames(mesh_part, axes, frames, choose_field(last[3], "plastic_strain"))
    draw_wall(axes, 1.25 * np.abs(last[1][:, :2]).max())
    for ax, (time, *_), note in zip(axes, frames, ("", "", ", cut open")):
        ax.set_title(f"{1e6 * time:.3g} µs{note}")

    history = read_history(directory)
    energy_axes = energy_part.subplots()
    plot_energies(energy_axes, {**history, "time": 1e6 * history["time"]})
    energy_axes.set(xlabel="time (µs)", ylabel="energy (J)")
    print(describe(last))
    save(figure, directory, name)
