"""The glued lap joint: the force it carries over the way of the grips, and where the energy goes.

Usage: lap_joint.py OUTPUT_DIR       writes OUTPUT_DIR/lap_joint.png, prints the energy of the bond
"""

import sys

import numpy as np

from akmon_io import read_history
from style import EXACT, NUMERICAL, plt, save

ENERGY = 1000 * 1e-4  # fracture energy times area, J
RISE = 20e-6          # of the grips' velocity


def main(directory):
    history = read_history(directory)
    time = history["time"]
    way = 2 * np.where(time < RISE, 0.5 * time**2 / RISE, time - 0.5 * RISE)
    print(f"bond energy: {history['bond_energy'][-1] / ENERGY:.5f} of fracture energy times area")

    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6))
    axes[0].plot(1e6 * way, 1e-3 * np.abs(history["glue.force_x"]), color=NUMERICAL)
    axes[0].set(title="Force in the glue", xlabel="way of the grips (micrometres)", ylabel="force (kN)")
    axes[1].axhline(ENERGY, color=EXACT, linewidth=2.2, alpha=0.45, label="fracture energy x area")
    for name, label, colour in (("bond_energy", "bond", NUMERICAL), ("strain_energy", "strain", "#3b6fb6"),
                                ("kinetic_energy", "kinetic", "#4a9c4f"), ("external_work", "work of the grips", "0.5")):
        axes[1].plot(1e6 * time, history[name], color=colour, label=label)
    axes[1].set(title="Energies", xlabel="time (microseconds)", ylabel="energy (J)")
    axes[1].legend()
    save(figure, directory, "lap_joint.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
