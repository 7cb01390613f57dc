"""A segmented neuron as a tree from its thickest node (the soma), and its cable by Strahler order.
Usage: neuroscience.py IMAGE FOLDER"""

import sys

import bccskel

image, folder = sys.argv[1:]
neuron = bccskel.skeletonize(bccskel.read(image), preset="neuron", root="thickest-node")
neuron.save(f"{folder}/neuron.swc")
print(neuron.to_pandas().groupby("strahler")["branch-distance"].agg(["count", "sum"]))
