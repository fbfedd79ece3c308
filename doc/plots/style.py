"""What all pictures share: no display, fonts, grid, colours, and how a picture is saved."""

import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

EXACT = "0.15"
NUMERICAL = "#c8452d"

plt.rcParams.update({
    "figure.constrained_layout.use": True,
    "savefig.dpi": 150,
    "font.size": 9.5,
    "axes.titlesize": 10.5,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.formatter.limits": (-3, 4),
    "axes.formatter.use_mathtext": True,
    "grid.color": "0.9",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "legend.fontsize": 8.5,
    "lines.linewidth": 1.4,
})


def save(figure, directory, name):
    """Write the picture into the directory and say where it is."""
    path = os.path.join(directory, name)
    figure.savefig(path)
    plt.close(figure)
    print(f"picture: {path}")
