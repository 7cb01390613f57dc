#!/bin/sh
# The pores of a gray micro-CT image, below a threshold: the branch table of their network, and lines for
# ParaView. Usage: materials.sh IMAGE THRESHOLD FOLDER
set -eu
bccskel skeletonize "$1" --local --below "$2" --preset materials -o "$3/pores.csv" -o "$3/pores.vtp"
