#!/usr/bin/python3
"""A picture of each garment, launch/garments/NAME.png, for the panel's list and the customer's page: the garment at 95 % on a body
of the virtual booth, from its side.

  garment_pictures.py [--programs build/devel/lib/tensegric_fit] [--work build/garment_pictures]

The scan and the fits are made in --work by the built programs and kept there; delete it to make them anew.
"""
import argparse
import pathlib
import subprocess

import matplotlib

matplotlib.use("Agg")
import numpy as np
from matplotlib import image

ROOT = pathlib.Path(__file__).resolve().parents[1]
GARMENTS = ROOT / "launch/garments"
SEED, RATIO = "7", "0.95"
PANEL = 600  # pixels: a body's part in front.png and back.png, the worn one last
STEP = 4  # pixels that become one


def made(path, *command):
    if not path.exists():
        subprocess.run(command, check=True)


def worn(path):
    """The worn body of a picture of `fit`, without its caption, smaller: RGB."""
    pixels = image.imread(path)[-PANEL:, -PANEL:, :3]
    return pixels.reshape(PANEL // STEP, STEP, PANEL // STEP, STEP, 3).mean(axis=(1, 3))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/devel/lib/tensegric_fit")
    arguments.add_argument("--work", type=pathlib.Path, default=ROOT / "build/garment_pictures")
    given = arguments.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    scan = given.work / "booth/scan.ply"
    made(scan, given.programs / "virtual_booth", "--seed", SEED, "--out", scan.parent)
    for garment in sorted(GARMENTS.glob("*.yaml")):
        out = given.work / garment.stem
        made(out / "report.json", given.programs / "fit", "--scan", scan, "--garment", garment, "--ratio", RATIO, "--out", out)
        back = out / "back.png"
        picture = worn(back if back.exists() else out / "front.png")
        image.imsave(garment.with_suffix(".png"), np.clip(picture, 0, 1), metadata={"Software": None})


if __name__ == "__main__":
    main()
