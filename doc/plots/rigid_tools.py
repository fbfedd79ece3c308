"""Rigid tools: the rolling cylinder, the spinning box, the sphere on a slab and the rounded punch.

Usage: rigid_tools.py OUTPUT [OUTPUT_DIR...]   writes OUTPUT; a panel per run, told by its columns
"""

import sys

import numpy as np

from akmon_io import read_history
from style import EXACT, NUMERICAL, plt


def rolling(ax, history):
    """Velocity down the slope against a = (2/3) g sin(30 degrees)."""
    time = history["time"]
    ax.plot(time, 2 / 3 * 9.81 * 0.5 * time, color=EXACT, linewidth=2.5, alpha=0.45, label="(2/3) g t sin")
    ax.plot(time, history["cylinder.velocity_x"], color=NUMERICAL, linewidth=1, label="velocity")
    ax.plot(time, 0.5 * history["cylinder.spin_y"], "--", color="#2b6cb0", linewidth=1, label="spin times radius")
    ax.set(title="Rolling cylinder", xlabel="time")
    ax.legend()


def spinning(ax, history):
    """Where the energy of the falling box goes."""
    time = history["time"]
    lost = history["impact_dissipation"] + history["friction_dissipation"]
    ax.plot(time, history["kinetic_energy"], color=NUMERICAL, label="kinetic")
    ax.plot(time, lost, color="#7b4fa3", label="dissipation")
    ax.plot(time, history["external_work"] - lost + history["kinetic_energy"][0], "--", color=EXACT, linewidth=1,
            label="initial + external - dissipation")
    ax.set(title="Spinning box", xlabel="time")
    ax.legend()


def hertz(ax, history):
    """Force over indentation against Hertz."""
    modulus = 1 / (1 - 0.3 ** 2)
    indentation = np.maximum(-history["sphere.displacement_z"], 0)
    d = np.linspace(0, indentation.max(), 200)
    ax.plot(d, 4 / 3 * modulus * d ** 1.5, color=EXACT, linewidth=2.5, alpha=0.45, label="Hertz")
    ax.plot(indentation, -4 * history["sphere.force_z"], color=NUMERICAL, linewidth=1, label="Akmon")
    ax.set(title="Sphere on a slab", xlabel="indentation", ylabel="force")
    ax.legend()


def punch(ax, history):
    """Force over displacement, pressed in and lifted."""
    ax.plot(-1e3 * history["punch.displacement_z"], -4e-3 * history["punch.force_z"], color=NUMERICAL, linewidth=1)
    ax.set(title="Rounded punch in copper", xlabel="depth (mm)", ylabel="force (kN)")


PANELS = {"cylinder.velocity_x": rolling, "box.spin_x": spinning, "sphere.force_z": hertz, "punch.force_z": punch}


def main(output, directories):
    figure, axes = plt.subplots(1, len(directories), figsize=(3.6 * len(directories), 3.3), squeeze=False)
    for ax, directory in zip(axes[0], directories):
        history = read_history(directory)
        for column, draw in PANELS.items():
            if column in history:
                draw(ax, history)
    figure.savefig(output)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit("usage: rigid_tools.py OUTPUT OUTPUT_DIR...")
    main(sys.argv[1], sys.argv[2:])
