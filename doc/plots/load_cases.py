"""A pushed sled, a settling column, a ringing bar, a hammer on a preloaded bar, thrown rigid bodies.

Usage: load_cases.py OUTPUT OUTPUT_DIR...   writes OUTPUT; a panel per run, told by its columns
"""

import sys

import numpy as np

from akmon_io import read_history
from style import EXACT, NUMERICAL, plt


def sled(ax, history):
    """Velocity under a force history, against Coulomb's law."""
    time, mass, limit = history["time"], 456.0, 0.2 * 456 * 9.81
    start = 2 / np.pi * np.arcsin(limit / 2000)
    impulse = 4000 / np.pi * (np.cos(np.pi * start / 2) - np.cos(np.pi * np.minimum(time, 2) / 2)) - limit * (time - start)
    ax.plot(time, np.where(time < start, 0, np.maximum(impulse / mass, 0)), color=EXACT, linewidth=2.5, alpha=0.45,
            label="Coulomb")
    ax.plot(time, history["sled.velocity_x"], color=NUMERICAL, linewidth=1, label="velocity")
    ax.set(title="Sled pushed by a force history", xlabel="time")


def column(ax, history):
    """Force on the floor and stresses against statics; the damping ends at 6."""
    time = history["time"]
    ax.axhline(1, color=EXACT, linewidth=2.5, alpha=0.45, label="statics")
    ax.axvline(6, color="0.6", linewidth=1, linestyle=":", label="damping ends")
    ax.plot(time, history["floor.force_z"] / 40, color=NUMERICAL, linewidth=1, label="force on the floor")
    ax.plot(time, history["bottom.stress_zz"] / -38.75, "--", color="#3b6fb6", linewidth=1, label="stress, bottom")
    ax.plot(time, history["middle.stress_zz"] / -20, "--", color="#4a9c4f", linewidth=1, label="stress, middle")
    ax.set(title="Settling column", xlabel="time")


def bar(ax, history):
    """Displacement of the end over the exact one."""
    time, omega = history["time"], np.pi / 10
    ax.plot(time, 1e-4 / omega * np.sin(omega * time), color=EXACT, linewidth=2.5, alpha=0.45, label="exact")
    ax.plot(time, history["end.displacement_x"], color=NUMERICAL, linewidth=1, label="end of the bar")
    ax.set(title="Bar with velocities by position", xlabel="time")


def hammer(ax, history):
    """Speed of the hammer over de Saint-Venant's."""
    time = history["time"]
    impact = time[np.argmax(history["hammer.force_z"] != 0)]
    after = (time > impact) & (time < impact + 20)
    ax.plot(time[after], 0.02 * np.exp(-(time[after] - impact) / 4), color=EXACT, linewidth=2.5, alpha=0.45,
            label="de Saint-Venant")
    shown = (time > impact - 5) & (time < impact + 20)
    ax.plot(time[shown], -history["hammer.velocity_z"][shown], color=NUMERICAL, linewidth=1, label="hammer's speed")
    ax.plot(time[shown], -history["top.stress_zz"][shown], color="#3b6fb6", linewidth=1, label="pressure at the top")
    ax.set(title="Hammer on a preloaded bar", xlabel="time")


def thrown(ax, history):
    """Energies of the thrown bodies and the slab."""
    time = history["time"]
    lines = {"kinetic": history["kinetic_energy"], "strain": history["strain_energy"],
             "friction": history["friction_dissipation"], "impact": history["impact_dissipation"]}
    for (label, values), colour in zip(lines.items(), (NUMERICAL, "#3b6fb6", "#4a9c4f", "#7b4fa3")):
        ax.plot(time, values, color=colour, linewidth=1, label=label)
    ax.plot(time, sum(lines.values()), "--", color=EXACT, linewidth=1, label="sum")
    ax.set(title="Thrown torus, sphere, mesh body", xlabel="time")


PANELS = {"floor.force_x,sled.velocity_x": sled, "bottom.stress_zz": column, "end.displacement_x": bar,
          "hammer.velocity_z": hammer, "torus.force_z": thrown}


def main(output, directories):
    figure, axes = plt.subplots(1, len(directories), figsize=(3.6 * len(directories), 3.3), squeeze=False)
    for ax, directory in zip(axes[0], directories):
        history = read_history(directory)
        for columns, draw in PANELS.items():
            if all(column in history for column in columns.split(",")):
                draw(ax, history)
                ax.legend(fontsize=7)
    figure.savefig(output)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit("usage: load_cases.py OUTPUT OUTPUT_DIR...")
    main(sys.argv[1], sys.argv[2:])
