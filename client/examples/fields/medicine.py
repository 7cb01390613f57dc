"""An airway tree as markups for 3D Slicer, and the mean diameter of each generation.
Usage: medicine.py IMAGE FOLDER"""

import sys

import bccskel

image, folder = sys.argv[1:]
airway = bccskel.skeletonize(bccskel.read(image), preset="airway", root="thickest-end")
airway.save(f"{folder}/airway.mrk.json")
print(2 * airway.to_pandas().groupby("generation")["mean-radius"].mean())
