"""Read what a run leaves in its output directory: history.csv, fields.pvd and the .vtu files."""

import base64
import csv
import os
import xml.etree.ElementTree as ElementTree
import zlib

import numpy as np

HEXAHEDRON = 12  # VTK's number of the cell type

DTYPES = {"Float32": "f4", "Float64": "f8", "Int8": "i1", "UInt8": "u1", "Int32": "i4",
          "UInt32": "u4", "Int64": "i8", "UInt64": "u8"}


def read_history(directory):
    """The columns of history.csv by name, as arrays."""
    with open(os.path.join(directory, "history.csv"), newline="") as file:
        rows = [row for row in csv.reader(file) if row]
    names = [name.strip() for name in rows[0]]
    values = np.array(rows[1:], dtype=float).reshape(-1, len(names))
    return dict(zip(names, values.T))


def read_pvd(directory):
    """The (time, path) of every output of fields.pvd, in the order of time."""
    root = ElementTree.parse(os.path.join(directory, "fields.pvd")).getroot()
    frames = [(float(data.get("timestep")), os.path.join(directory, data.get("file")))
              for data in root.iter("DataSet")]
    return sorted(frames)


def decode(array, byte_order):
    """The numbers of a DataArray element, text or zlib-compressed base64."""
    dtype = np.dtype(DTYPES[array.get("type")])
    text = array.text or ""
    if array.get("format") == "ascii":
        values = np.array(text.split(), dtype=dtype)
    else:
        dtype = dtype.newbyteorder(byte_order)
        word = np.dtype("u4").newbyteorder(byte_order)
        text = "".join(text.split())
        # The header is encoded by itself, padding included: number of blocks, size of a block, size
        # of the last block, compressed sizes.
        n_blocks = int(np.frombuffer(base64.b64decode(text[:8])[:4], word)[0]) if text else 0
        n_header = 4 * ((4 * (3 + n_blocks) + 2) // 3)
        sizes = np.frombuffer(base64.b64decode(text[:n_header]), word)[3:] if n_blocks else []
        blob = base64.b64decode(text[n_header:])
        ends = np.cumsum(sizes, dtype=int)
        values = np.frombuffer(b"".join(zlib.decompress(blob[end - size:end])
                                        for size, end in zip(sizes, ends)), dtype)
    components = int(array.get("NumberOfComponents", 1))
    return values.reshape(-1, components) if components > 1 else values


def read_vtu(path):
    """Points (n, 3), hexahedra (m, 8) in VTK's order, and point data by name, of all pieces of a file."""
    root = ElementTree.parse(path).getroot()
    byte_order = ">" if root.get("byte_order") == "BigEndian" else "<"
    if root.get("compressor") not in (None, "vtkZLibDataCompressor"):
        raise ValueError(f"{path}: unknown compressor {root.get('compressor')}")

    points, cells, data = [], [], {}
    n_points = 0
    for piece in root.iter("Piece"):
        if int(piece.get("NumberOfPoints")) == 0:
            continue  # a rank without cells
        topology = {array.get("Name"): decode(array, byte_order)
                    for array in piece.find("Cells").iter("DataArray")}
        if np.any(topology["types"] != HEXAHEDRON):
            raise ValueError(f"{path}: has cells that are no hexahedra")
        points.append(decode(piece.find("Points/DataArray"), byte_order))
        cells.append(topology["connectivity"].astype(np.int64).reshape(-1, 8) + n_points)
        n_points += len(points[-1])
        for array in piece.find("PointData").iter("DataArray"):
            data.setdefault(array.get("Name"), []).append(decode(array, byte_order))
    return (np.concatenate(points).astype(float), np.concatenate(cells),
            {name: np.concatenate(values) for name, values in data.items()})


def read_frames(directory, indices):
    """The (time, current points, cells, point data) of those outputs of a run.

    Files may hold the mesh as it was at the start, to be warped by the field "displacement", or as it
    is: points that stay where they were although there is a displacement are those of the start.
    """
    outputs = read_pvd(directory)
    initial = read_vtu(outputs[0][1])[0]
    frames = []
    for index in indices:
        time, path = outputs[index]
        points, cells, data = read_vtu(path)
        if "displacement" in data and np.array_equal(points, initial):
            points = points + data["displacement"]
        frames.append((time, points, cells, data))
    return frames
