"""The copper Taylor bar: mesh before and after, and energies.

Usage: taylor_bar.py OUTPUT_DIR        writes OUTPUT_DIR/taylor_bar.png
"""

import sys

from bar_picture import draw_bar

if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: taylor_bar.py OUTPUT_DIR")
    draw_bar(sys.argv[1], "taylor_bar.png")
