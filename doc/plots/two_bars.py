"""Two elastic bars: the run against the exact one-dimensional solution, as in Figure 2 of the paper.

Usage: two_bars.py OUTPUT_DIR        writes OUTPUT_DIR/two_bars.png, prints the largest deviations
"""

import sys

import numpy as np

from akmon_io import read_history
from style import EXACT, NUMERICAL, plt, save

E, RHO, LENGTH, AREA, V0, HALF_GAP = 3e7, 7.337e-4, 10.0, 1.0, 202.2, 0.01
C = np.sqrt(E / RHO)
T_IMPACT = HALF_GAP / V0
T_RELEASE = T_IMPACT + 2 * LENGTH / C
FORCE = RHO * C * V0 * AREA


def exact(time):
    """Displacement and velocity of the left bar's impact face, and the contact force."""
    touching = (time >= T_IMPACT) & (time <= T_RELEASE)
    before = time < T_IMPACT
    displacement = np.where(before, V0 * time, HALF_GAP - V0 * np.maximum(time - T_RELEASE, 0))
    velocity = np.where(before, V0, np.where(touching, 0.0, -V0))
    return displacement, velocity, np.where(touching, FORCE, 0.0)


def deviations(time, displacement, velocity, force):
    """One line: displacement over the whole run, velocity and force inside the time of contact.

    The edges of the contact time are left out: the exact solution jumps there.
    """
    margin = 0.05 * (T_RELEASE - T_IMPACT)
    inside = (time > T_IMPACT + margin) & (time < T_RELEASE - margin)
    line = f"largest deviations: displacement {np.abs(displacement - exact(time)[0]).max() / HALF_GAP:.2e} g"
    if inside.any():
        line += (f"; in contact: velocity {np.abs(velocity[inside]).max() / V0:.2e} v0"
                 f", force {np.abs(force[inside] / FORCE - 1).max():.2e} rho c v0 A"
                 f" (mean force {force[inside].mean() / FORCE - 1:+.2e})")
    return line


def main(directory):
    history = read_history(directory)
    columns = ("time", "left_face.displacement_x", "left_face.velocity_x", "interface.force_x")
    missing = [name for name in columns if name not in history]
    if missing:
        sys.exit(f"two_bars.py: history.csv has no column {', '.join(missing)}")
    time, displacement, velocity, force = (history[name] for name in columns)
    force = np.abs(force)

    # Both sides of a jump are samples of the exact solution, so that it is drawn upright.
    jumps = [np.nextafter(t, side) for t in (T_IMPACT, T_RELEASE) for side in (0, 1)]
    exact_time = np.sort(np.concatenate([np.linspace(0, max(time[-1], T_RELEASE), 400), jumps]))

    figure, axes = plt.subplots(1, 3, figsize=(12, 3.5))
    titles = ("Displacement of the impact face", "Velocity of the impact face", "Contact force")
    for ax, title, numerical, reference in zip(axes, titles, (displacement, velocity, force), exact(exact_time)):
        ax.plot(exact_time, reference, color=EXACT, linewidth=2.2, alpha=0.45, label="exact (1D)")
        ax.plot(time, numerical, color=NUMERICAL, linewidth=1.1, marker=".", markersize=3, label="Akmon")
        ax.set(title=title, xlabel="time")
        ax.margins(y=0.12)
    axes[0].legend(loc="lower center")
    axes[1].legend(loc="upper right")
    axes[2].legend(loc="lower center")
    print(deviations(time, displacement, velocity, force))
    save(figure, directory, "two_bars.png")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: two_bars.py OUTPUT_DIR")
    main(sys.argv[1])
