"""The glued lap joint: the force it carries over the way of the grips, where the energy goes, and what is left
of the bonds along the glue as they fail.

Usage: lap_joint.py OUTPUT_DIR       writes OUTPUT_DIR/lap_joint.png, prints the energy of the bond
"""

import sys

import numpy as np

from akmon_io import read_history, read_pvd, read_vtu
from style import EXACT, NUMERICAL, plt, save

ENERGY = 1000 * 1e-4  # fracture energy times area, J
RISE = 20e-6          # of the grips' velocity


def bond_panel(ax, directory):
    """The field `bond` of the upper plate's glued face over the length of the joint, at times when it fails."""
    frames = [(time, path) for time, path in read_pvd(directory) if 2.9e-5 < time < 5.6e-5]
    for number, (time, path) in enumerate(frames):
        points, _, data = read_vtu(path)
        place = points - data["displacement"]
        glued = (data["body"] == 1) & (np.abs(place[:, 2]) < 1e-7) & (np.abs(place[:, 0]) < 5.1e-3)
        lengths = np.unique(np.round(1e3 * place[glued, 0], 3))
        means = [data["bond"][glued & (np.abs(1e3 * place[:, 0] - x) < 1e-2)].mean() for x in lengths]
        ax.plot(lengths, means, color=plt.cm.viridis(number / len(frames)), label=f"{1e6 * time:.0f}")
    ax.set(title="What is left of the bonds", xlabel="along the joint (mm)", ylabel="bond, mean across", ylim=(0, 1.05))
    ax.legend(title="microseconds", fontsize=7, title_fontsize=7)


def main(directory):
    history = read_history(directory)
    time = history["time"]
    way = 2 * np.where(time < RISE, 0.5 * time**2 / RISE, time - 0.5 * RISE)
    print(f"bond energy: {history['bond_energy'][-1] / ENERGY:.5f} of fracture energy times area")

    figure, axes = plt.subplots(1, 3, figsize=(14, 3.6))
    axes[0].plot(1e6 * way, 1e-3 * np.abs(history["glue.force_x"]), color=NUMERICAL)
    axes[0].set(title="Force in the glue", xlabel="way of the grips (micrometres)", ylabel="force (kN)")
    axes[1].axhline(ENERGY, color=EXACT, linewidth=2.2, alpha=0.45, label="fracture energy x area")
    for name, label, colour in (("bond_energy", "bond", NUMERICAL), ("strain_energy", "strain", "#3b6fb6"),
                                ("kinetic_energy", "kinetic", "#4a9c4f"), ("external_work", "work of the grips", "0.5")):
        axes[1].plot(1e6 * time, history[name], color=colour, label=label)
    axes[1].set(title="Energies", xlabel="time (microseconds)", ylabel="energy (J)")
    axes[1].legend()
    bond_panel(axes[2], directory)
    save(figure, directory, "lap_joint.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(sys.argv[1])
