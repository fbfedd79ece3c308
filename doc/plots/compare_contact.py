"""Penalty, decoupled and coupled contact in the same runs: a table, and the punch's force over its way.

Usage: compare_contact.py PROGRAM DIRECTORY [CASE]...
Runs PROGRAM (build/akmon) on two_bars with unequal meshes, the Taylor bar's quarter and rounded_punch, or
on the named ones of them, into subfolders of DIRECTORY, one after the other; prints the table as Markdown
and writes DIRECTORY/penalty_punch.png. Start it in the folder with prm/. Runs that are there already are
not run again. For seconds that mean something nothing else should run meanwhile.
"""

import json
import os
import subprocess
import sys

import numpy as np

from akmon_io import read_history
from style import EXACT, NUMERICAL, plt, save

SOLVERS = ("penalty", "decoupled", "coupled")
COLOURS = {"penalty": NUMERICAL, "decoupled": "#3b6fb6", "coupled": EXACT}


def plateau(history):
    rows = (history["time"] > 1.1e-4) & (history["time"] < 1.35e-4)
    force = -history["interface.force_x"][rows]
    return f"force {force.mean() / 29998.604:.4f} $\\rho c v_0 A$, scatter {force.std() / force.mean():.1e}"


def shortening(history):
    return f"{-history['top.displacement_z'][-1] * 1e3:.3f} mm shorter"


def largest_force(history):
    return f"largest force {4e-3 * np.abs(history['punch.force_z']).max():.2f} kN"


CASES = {
    "two_bars": ("two bars, 4 x 4 on 3 x 3", ["Bodies/right/Box/Cells=20, 3, 3"], plateau),
    "taylor_bar_quarter": ("Taylor bar, quarter of 288 cells",
                           ["Bodies/bar/Cylinder/Cells across=4", "Bodies/bar/Cylinder/Cells radial=2",
                            "Bodies/bar/Cylinder/Cells axial=24"], shortening),
    "rounded_punch": ("rounded punch, 14 x 14 x 8 cells", ["Bodies/block/Box/Cells=14, 14, 8"], largest_force),
}


def run(program, case, solver, directory):
    """The history and summary of a case with a solver; stops where the program does."""
    settings = CASES[case][1] + [f"Contact solver/Type={solver}", f"Output directory={directory}"]
    if case == "two_bars" and solver != "decoupled":
        settings.append("Contact/interface/Pass=symmetric")
    command = [program, os.path.join("prm", case + ".prm"), "--set", "Output/Fields interval=0"]
    for setting in settings:
        command += ["--set", setting]
    summary = os.path.join(directory, "summary.json")
    if not os.path.exists(summary):
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    with open(summary) as file:
        return read_history(directory), json.load(file)


def row(case, solver, history, summary):
    contact = sum(seconds for stage, seconds in summary["stage_seconds"].items() if stage.startswith("contact."))
    return (f"| {CASES[case][0]} | {solver} | {summary['max_penetration_rel']:.1e} | {abs(summary['energy_error']):.1e} | "
            f"{summary['steps']} | {summary['wall_seconds']:.2f} | {contact:.2f} | {CASES[case][2](history)} |")


def draw_punch(histories, directory):
    figure, axes = plt.subplots(1, 2, figsize=(10, 3.6))
    for solver, history in histories.items():
        way, force = -1e3 * history["punch.displacement_z"], 4e-3 * np.abs(history["punch.force_z"])
        style = {"color": COLOURS[solver], "linewidth": 2.4 if solver == "coupled" else 1.2,
                 "alpha": 0.45 if solver == "coupled" else 1, "label": solver}
        axes[0].plot(way, force, **style)
        axes[1].semilogy(1e6 * history["time"], np.maximum(history["max_penetration_rel"], 1e-18), **style)
    axes[0].set(title="Force on the punch", xlabel="indentation (mm)", ylabel="force (kN)")
    axes[1].set(title="Nodes inside the punch", xlabel="time (microseconds)", ylabel="penetration / cell size")
    axes[0].legend()
    save(figure, directory, "penalty_punch.png")


def main(program, directory, cases):
    unknown = [case for case in cases if case not in CASES]
    if unknown:
        sys.exit(f"compare_contact.py: allowed are {', '.join(CASES)}, not {', '.join(unknown)}")
    print("| case | contact | penetration | energy error | steps | seconds | of them contact | result |")
    print("|---|---|---|---|---|---|---|---|")
    for case in cases:
        histories = {}
        for solver in SOLVERS:
            history, summary = run(program, case, solver, os.path.join(directory, case + "_" + solver))
            histories[solver] = history
            print(row(case, solver, history, summary), flush=True)
        if case == "rounded_punch":
            draw_punch(histories, directory)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2], sys.argv[3:] or list(CASES))
