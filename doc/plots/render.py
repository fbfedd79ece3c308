"""Draw the deformed mesh at some outputs side by side, as Figures 3 and 4 of the paper.

Usage: render.py OUTPUT_DIR [--field NAME] [--frames 0,-1] [--out FILE.png]
"""

import argparse
import os
import sys

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.collections import PolyCollection
from matplotlib.colors import LinearSegmentedColormap, Normalize

from akmon_io import read_frames
from style import plt

# The faces of a hexahedron in VTK's order, seen counter-clockwise from outside.
FACES = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])

DEFAULT_FIELDS = ("plastic_strain", "von_mises", "displacement")
# Starts light, so that the lines of the mesh show where nothing has happened yet.
COLORMAP = LinearSegmentedColormap.from_list("akmon", ["#d3dae2", "#86b6d3", "#f3d675", "#e5733a", "#9c1c1c"])


def row_keys(rows):
    """One 64-bit number per row of whole numbers: unique() of numbers is much faster than of rows."""
    multipliers = np.random.default_rng(1).integers(1, 2**63, rows.shape[1], dtype=np.uint64)
    keys = np.zeros(len(rows), dtype=np.uint64)
    for column, multiplier in zip(rows.T, multipliers):
        keys = (keys ^ column.astype(np.int64).view(np.uint64)) * (multiplier | np.uint64(1))
        keys ^= keys >> np.uint64(29)
    return keys


def merge_vertices(points, body, tolerance):
    """For each point the number of the vertex it is; cells of one body share vertices, bodies never do."""
    vertex = np.arange(len(points))
    # Points equal but for round-off may straddle a line of one rounding grid, hardly of the shifted one too.
    for shift in (0.0, 0.5):
        first, inverse = np.unique(vertex, return_index=True, return_inverse=True)[1:]
        keys = np.column_stack([np.rint(points[first] / tolerance + shift), np.rint(body[first])])
        _, representative, group = np.unique(row_keys(keys), return_index=True, return_inverse=True)
        vertex = first[representative][group][inverse]
    return vertex


def surface_quads(points, cells, body):
    """The faces that belong to one cell only, as (n, 4) indices of points, oriented outwards."""
    edges = points[cells[:, [1, 3, 4]]] - points[cells[:, [0]]]
    tolerance = 1e-2 * np.linalg.norm(edges, axis=-1).min()
    quads = cells[:, FACES].reshape(-1, 4)
    vertices = np.sort(merge_vertices(points, body, tolerance)[quads], axis=1)
    _, first, count = np.unique(row_keys(vertices), return_index=True, return_counts=True)
    return quads[first[count == 1]]


def camera(elevation, azimuth):
    """The unit vectors to the right, up and towards the viewer, for angles in degrees."""
    e, a = np.radians([elevation, azimuth])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0.0])
    return np.array([right, np.cross(towards, right), towards])


VIEW = camera(elevation=22.0, azimuth=-62.0)


def draw_mesh(ax, points, cells, scalar, body=None, norm=None, view=VIEW):
    """Draw the surface of the mesh in parallel projection, coloured by a scalar at the points.

    The projection is done here and the polygons go to plain axes: many times faster than 3D axes, and
    the picture fills its frame.
    """
    if body is None:
        body = np.zeros(len(points))
    if norm is None:
        norm = Normalize(scalar.min(), scalar.max())
    quads = surface_quads(points, cells, body)
    corners = points[quads] @ view.T
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)

    visible = normals[:, 2] > 0
    corners, normals, quads = corners[visible], normals[visible], quads[visible]
    order = np.argsort(corners[:, :, 2].mean(axis=1))  # the far ones first
    corners, normals, quads = corners[order], normals[order], quads[order]

    light = np.array([0.35, 0.55, 0.76])  # over the viewer's right shoulder
    shade = 0.62 + 0.38 * np.clip(normals @ light, 0, 1)
    colors = COLORMAP(norm(scalar[quads].mean(axis=1)))
    colors[:, :3] *= shade[:, None]

    # Lines get thinner with the faces, so that a fine mesh is not drawn black.
    line_width = float(np.clip(20 / np.sqrt(len(quads) + 1), 0.08, 0.6))
    ax.add_collection(PolyCollection(corners[:, :, :2], facecolors=colors, edgecolors=(0.08, 0.08, 0.1, 0.8),
                                     linewidths=line_width))
    ax.set_aspect("equal")
    ax.axis("off")
    ax.autoscale_view()


def scalar_of(data, field):
    """The field at the points as one number each: the magnitude of a vector."""
    values = data[field]
    return np.linalg.norm(values, axis=1) if values.ndim > 1 else values


def choose_field(data, field=None):
    """The field asked for, or the most telling one there is."""
    if field is None:
        field = next((name for name in DEFAULT_FIELDS if name in data), None)
    if field not in data:
        sys.exit(f"no field {field}; there are: {', '.join(sorted(data))}")
    return field


def draw_frames(figure, axes, frames, field):
    """Draw each frame into its axes, to one scale of length and of colour, with one colour bar."""
    scalars = [scalar_of(data, field) for _, _, _, data in frames]
    low, high = min(s.min() for s in scalars), max(s.max() for s in scalars)
    norm = Normalize(min(0.0, low), high if high > low else low + 1)
    for ax, scalar, (time, points, cells, data) in zip(axes, scalars, frames):
        draw_mesh(ax, points, cells, scalar, data.get("body"), norm)
        ax.set_title(f"t = {time:.4g}")
    limits = np.array([[*ax.get_xlim(), *ax.get_ylim()] for ax in axes])
    for ax in axes:
        ax.set_xlim(limits[:, 0].min(), limits[:, 1].max())
        ax.set_ylim(limits[:, 2].min(), limits[:, 3].max())
    bar = figure.colorbar(ScalarMappable(norm, COLORMAP), ax=axes, shrink=0.75, aspect=22, pad=0.02)
    bar.set_label(field.replace("_", " "))
    bar.outline.set_visible(False)


def new_figure(frames):
    """A figure with axes for each frame: side by side, or one above the other if the bodies lie flat."""
    seen = np.concatenate([points for _, points, _, _ in frames]) @ VIEW.T
    width, height = np.ptp(seen, axis=0)[:2]
    if width > 1.5 * height:
        size = 7.0 * height / width
        return plt.subplots(len(frames), 1, figsize=(8.2, max(len(frames) * (size + 0.4), 2.4)), squeeze=False)
    return plt.subplots(1, len(frames), figsize=(3.6 * len(frames) + 1.0, 4.4), squeeze=False)


def frame_indices(text):
    return [int(entry) for entry in text.split(",")]


def main():
    parser = argparse.ArgumentParser(description="Draw the deformed mesh at some outputs side by side.")
    parser.add_argument("directory", metavar="OUTPUT_DIR")
    parser.add_argument("--field", help="point field that gives the colour")
    parser.add_argument("--frames", type=frame_indices, default=[0, -1], metavar="FIRST,LAST",
                        help="numbers of the outputs, negative from the end (default: 0,-1)")
    parser.add_argument("--out", metavar="FILE.png", help="default: OUTPUT_DIR/mesh.png")
    arguments = parser.parse_args()

    frames = read_frames(arguments.directory, arguments.frames)
    figure, axes = new_figure(frames)
    draw_frames(figure, list(axes.flat), frames, choose_field(frames[-1][3], arguments.field))
    path = arguments.out or os.path.join(arguments.directory, "mesh.png")
    figure.savefig(path)
    print(f"picture: {path}")


if __name__ == "__main__":
    main()
