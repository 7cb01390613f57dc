"""The network of pores below a threshold: a table, and throats and tortuosity.
Usage: materials.py IMAGE THRESHOLD FOLDER"""

import sys

import bccskel

image, threshold, folder = sys.argv[1:]
pores = bccskel.skeletonize(bccskel.read(image), below=float(threshold), preset="materials")
pores.save(f"{folder}/pores.csv")
print(pores.to_pandas()[["branch-distance", "min-radius", "tortuosity"]].describe())
