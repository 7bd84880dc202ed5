"""Functions that the example scripts share: they read the options and save a figure."""
import argparse

import matplotlib

matplotlib.use("Agg")  # no window
import matplotlib.pyplot as plt


def options(text):
    """Returns the options -o FILE, --points N and --set KEY=VALUE."""
    parser = argparse.ArgumentParser(description=text)
    parser.add_argument("-o", dest="output", required=True, help="PNG or SVG file")
    parser.add_argument("--points", type=int, default=200, help="points along an axis [200]")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="a parameter of tyndall")
    found = parser.parse_args()
    found.parameters = dict(word.split("=", 1) for word in found.set)
    return found


def save(figure, path):
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    plt.close(figure)
