#!/bin/sh
# A segmented neuron in an image stack: a tree for neuron tools, rooted at the thickest node (the soma), the
# branch table, and a page for the browser. Usage: neuroscience.sh IMAGE FOLDER
set -eu
bccskel skeletonize "$1" --local --preset neuron --root thickest-node \
  -o "$2/neuron.swc" -o "$2/neuron.csv" -o "$2/neuron.html"
