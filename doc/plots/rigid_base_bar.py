"""The paper's bar on a rigid base: mesh before and after (Figures 3 and 4) and energies.

Usage: rigid_base_bar.py OUTPUT_DIR        writes OUTPUT_DIR/rigid_base_bar.png
"""

import sys

from bar_picture import draw_bar

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: rigid_base_bar.py OUTPUT_DIR")
    draw_bar(sys.argv[1], "rigid_base_bar.png")
