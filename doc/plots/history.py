"""The generic picture of a run, from history.csv: energies, errors, contact pairs over time.

Usage: history.py OUTPUT_DIR        writes OUTPUT_DIR/history.png
"""

import sys

import numpy as np

from akmon_io import read_history
from style import plt, save

ENERGIES = {
    "kinetic_energy": ("kinetic", "#2b6cb0"),
    "strain_energy": ("strain", "#2f8f5b"),
    "plastic_dissipation": ("plastic dissipation", "#c8452d"),
    "friction_dissipation": ("friction dissipation", "#d99a1c"),
    "impact_dissipation": ("impact dissipation", "#7b4fa3"),
    "damping_dissipation": ("damping dissipation", "#4fb0c6"),
    "external_work": ("external work", "#8c6d46"),
}


def plot_energies(axes, history):
    """All energies that matter in this run, and their sum, which external work alone may change."""
    largest = max(np.abs(history[name]).max() for name in ENERGIES)
    for name, (label, color) in ENERGIES.items():
        if np.abs(history[name]).max() > 1e-4 * largest:
            axes.plot(history["time"], history[name], color=color, label=label)
    total = sum(history[name] for name in ENERGIES if name != "external_work")
    axes.plot(history["time"], total, "--", color="0.35", linewidth=1, label="energies and losses")
    # Room for the legend above the curves.
    legend_rows = (len(axes.lines) + 1) // 2
    axes.set(title="Energies", xlabel="time")
    axes.set_ylim(top=(1.08 + 0.11 * legend_rows) * largest)
    axes.legend(ncol=2, loc="upper center", handlelength=1.4, columnspacing=1.2)


def plot_errors(axes, history):
    """Energy error and penetration; a perfect zero is drawn at the bottom, at the size of round-off."""
    floor = 1e-17
    for name, label, color in (("energy_error", "energy error / largest energy", "#2b6cb0"),
                               ("max_penetration_rel", "penetration / cell size", "#c8452d")):
        axes.semilogy(history["time"], np.maximum(np.abs(history[name]), floor), color=color, label=label)
    axes.set(title="Errors", xlabel="time")
    axes.set_ylim(floor, 1.0)
    axes.legend(loc="upper right")


def plot_pairs(axes, history):
    """Active contact pairs and, if there is friction that holds, the sticking ones."""
    axes.fill_between(history["time"], history["active_pairs"], step="post", color="#2b6cb0", alpha=0.25,
                      linewidth=0)
    axes.step(history["time"], history["active_pairs"], where="post", color="#2b6cb0", label="active")
    if history["sticking_pairs"].any():
        axes.step(history["time"], history["sticking_pairs"], where="post", color="#d99a1c", label="sticking")
    axes.set(title="Contact pairs", xlabel="time")
    axes.set_ylim(0, max(1.0, 1.2 * history["active_pairs"].max()))
    axes.legend(loc="upper right", ncol=2)


def main(directory):
    history = read_history(directory)
    figure, axes = plt.subplots(1, 3, figsize=(12, 3.5))
    plot_energies(axes[0], history)
    plot_errors(axes[1], history)
    plot_pairs(axes[2], history)
    save(figure, directory, "history.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: history.py OUTPUT_DIR")
    main(sys.argv[1])
