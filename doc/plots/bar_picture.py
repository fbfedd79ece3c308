"""The picture of a bar that hits a rigid wall: mesh before and after, energies over time."""

from akmon_io import read_frames, read_history
from history import plot_energies
from render import choose_field, draw_frames
from style import plt, save


def draw_bar(directory, name):
    """Write DIRECTORY/NAME: initial and final mesh coloured by plastic strain, and the energies."""
    frames = read_frames(directory, (0, -1))
    figure = plt.figure(figsize=(12, 4.2))
    mesh_part, energy_part = figure.subfigures(1, 2, width_ratios=(1.35, 1), wspace=0.04)
    axes = mesh_part.subplots(1, len(frames))
    draw_frames(mesh_part, list(axes), frames, choose_field(frames[-1][3], "plastic_strain"))
    plot_energies(energy_part.subplots(), read_history(directory))
    save(figure, directory, name)
