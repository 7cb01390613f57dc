#!/bin/sh
# An airway tree in a scan: markups for 3D Slicer, the branches with generations and Strahler orders, and a
# picture. Usage: medicine.sh IMAGE FOLDER
set -eu
bccskel skeletonize "$1" --local --preset airway --root thickest-end \
  -o "$2/airway.mrk.json" -o "$2/airway.csv" -o "$2/airway.png"
